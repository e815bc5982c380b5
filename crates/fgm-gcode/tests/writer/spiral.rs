//! Turns of a spiral as G-code.

use super::*;

/// A square wall of a spiral in two colours, half of it in each.
fn turn(index: u32, from: f64) -> Vec<Motion> {
    let mut motions = vec![layer(index), Motion::Rise { from, length: 40.0 }];
    motions.extend([travel(0.0, 0.0), color(0), line(10.0, 0.0), line(10.0, 10.0), color(1)]);
    motions.extend([line(0.0, 10.0), line(0.0, 0.0)]);
    motions
}

#[test]
fn a_spiral_rises_bead_by_bead_in_every_dialect() {
    for name in Machine::builtin_names() {
        let machine = machine(name);
        if machine.kind == MachineKind::ToolChanger {
            continue;
        }
        let mut print = vec![layer(0), travel(-5.0, 0.0), color(0), line(0.0, 0.0)];
        print.extend(turn(1, 0.2));
        print.extend(turn(2, 0.4));
        // The rim is flat.
        print.extend([line(10.0, 0.0), line(10.0, 10.0)]);
        let lead = Lead::with_volume(&machine, 1.0).over(print);
        let (text, summary) = write(&machine, &options(&machine), lead).unwrap();
        let begin = text.find(";LAYER_CHANGE\n;Z:0.4").unwrap();
        let (mut z, mut heights, mut length) = (0.2, Vec::new(), 0.0);
        let mut at = [100.0, 100.0];
        for command in lines(&text.as_bytes()[begin..]).filter_map(|line| line.command) {
            let axis = |letter, at| command.value(letter).unwrap_or(at);
            let to = [axis(b'X', at[0]), axis(b'Y', at[1])];
            if !command.is(b'G', 1) || to == at || length > 99.0 {
                continue;
            }
            assert!(command.value(b'E').is_some_and(|e| e > 0.0), "{name}: a travel to {to:?}");
            length += (to[0] - at[0]).abs() + (to[1] - at[1]).abs();
            at = to;
            z = axis(b'Z', z);
            let wanted = 0.2 + 0.2 * (length / 40.0_f64).min(2.0);
            assert!((z - wanted).abs() < 0.000_501, "{name}: {z} for {wanted}");
            heights.push(z);
        }
        assert!((length - 100.0).abs() < 1e-9, "{name}: {length}");
        assert!(heights.windows(2).all(|w| w[0] <= w[1]), "{name}: {heights:?}");
        assert_eq!((heights[heights.len() - 1], summary.extents.max.z), (0.6, 0.6), "{name}");
    }
}

/// Heights that lie in the middle between two that can be written must not go down by rounding.
#[test]
fn rounding_lets_no_turn_go_down() {
    let machine = machine("generic-mixing");
    let mut print = vec![layer(0), travel(-5.0, 0.0), color(0), line(0.0, 0.0)];
    let mut top = 0.2;
    for index in 1..60 {
        let (from, height) = (top, 0.100_5);
        top = 0.2 + f64::from(index) * height;
        print.extend([Motion::Layer { index, z: top, height }, Motion::Rise { from, length: 4.0 }]);
        print.extend([travel(0.0, 0.0), line(1.0, 0.0), line(1.0, 1.0), line(0.0, 1.0)]);
        print.push(line(0.0, 0.0));
    }
    let (text, _) = write(&machine, &options(&machine), steps(&print)).unwrap();
    let begin = text.find(";LAYER_CHANGE").unwrap();
    let heights: Vec<f64> = lines(&text.as_bytes()[begin..])
        .filter_map(|line| line.command)
        .filter(|c| c.is(b'G', 1) && c.value(b'E').is_some_and(|e| e > 0.0))
        .filter_map(|c| c.value(b'Z'))
        .collect();
    assert!(heights.len() > 200 && heights.windows(2).all(|w| w[0] < w[1]), "{heights:?}");
}
