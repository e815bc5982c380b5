//! Any bytes are followed as G-code and laid down through a slow nozzle: every number that comes
//! out is one, and what is fed is what is laid down.
#![no_main]

use fgm_gcode::{Machine, Reader};
use fgm_sim::{CheckOptions, Deposit, Event, Head, Replay, Thermal, Transition, check};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (u8, &[u8])| {
    let (choice, bytes) = input;
    let machine = Machine::builtin_names().nth(usize::from(choice % 12)).and_then(Machine::builtin);
    let mut options = CheckOptions::of(machine.as_ref());
    options.replay.tagged_layers = choice & 0x80 != 0;
    options.model.transition = Transition { delay: 3.0, length: f64::from(choice & 0x40) };
    options.model.thermal =
        (choice & 0x20 != 0).then_some(Thermal { heating: 2.0, cooling: 1.0, time_constant: 5.0 });

    let mut reader = Reader::new(bytes);
    let Ok(_) = Head::read(&mut reader) else { return };
    let mut replay = Replay::new(reader, &options.replay);
    let mut deposit = Deposit::new(&options.model);
    while let Ok(Some(event)) = replay.next_event() {
        let mut fed = 0.0;
        deposit.push(&event, &mut |piece| {
            assert!(piece.from.is_finite() && piece.to.is_finite());
            assert!(piece.volume.is_finite() && piece.volume >= 0.0);
            fed += piece.fed;
        });
        if let Event::Bead(bead) = event {
            assert!((fed - bead.fed).abs() <= 1e-6 * bead.fed + 1e-6, "{fed} {}", bead.fed);
        }
    }
    let _ = check(Reader::new(bytes), &options, None, &mut |_| Ok(()));
});
