use super::issues::MeshIssues;
use super::topology::OPEN;
use super::weld::Welded;
use fgm_core::{Bounds3, Point3};

/// One connected part of a mesh.
#[derive(Clone, Copy, Debug)]
struct Shell {
    bounds: Bounds3,
    volume: f64,
}

/// Marks the triangles of shells that face inwards although no other shell is around them: their
/// sections are to be turned, so that they add to what they overlap instead of cancelling it.
/// Empty where there are none.
pub(crate) fn inverted(mesh: &Welded, mates: &[u32], issues: &mut MeshIssues) -> Vec<bool> {
    let (shell_of, shells) = find(mesh, mates);
    let around = |outer: &Shell, inner: &Shell| {
        outer.bounds.min.cmple(inner.bounds.min).all()
            && inner.bounds.max.cmple(outer.bounds.max).all()
            && outer.bounds != inner.bounds
    };
    let turned: Vec<bool> = shells
        .iter()
        .map(|s| s.volume < 0.0 && !shells.iter().any(|o| o.volume > 0.0 && around(o, s)))
        .collect();
    if !turned.contains(&true) {
        return Vec::new();
    }
    for (shell, _) in shells.iter().zip(&turned).filter(|s| *s.1) {
        issues.inverted_shells.add(shell.bounds.center());
    }
    shell_of.iter().map(|&s| turned[s as usize]).collect()
}

fn find(mesh: &Welded, mates: &[u32]) -> (Vec<u32>, Vec<Shell>) {
    let mut shell_of = vec![OPEN; mesh.triangles.len()];
    let mut shells = Vec::new();
    let mut stack = Vec::new();
    for seed in 0..mesh.triangles.len() {
        if shell_of[seed] != OPEN {
            continue;
        }
        let id = shells.len() as u32;
        let origin = mesh.vertices[mesh.triangles[seed][0] as usize];
        let mut shell = Shell { bounds: Bounds3::EMPTY, volume: 0.0 };
        shell_of[seed] = id;
        stack.push(seed);
        while let Some(t) = stack.pop() {
            let corners = mesh.triangles[t].map(|v| mesh.vertices[v as usize]);
            shell.bounds = shell.bounds.union(&Bounds3::of(corners));
            let [a, b, c]: [Point3; 3] = corners.map(|p| p - origin);
            shell.volume += a.dot(b.cross(c));
            for &mate in &mates[3 * t..3 * t + 3] {
                if mate != OPEN && shell_of[mate as usize / 3] == OPEN {
                    shell_of[mate as usize / 3] = id;
                    stack.push(mate as usize / 3);
                }
            }
        }
        shells.push(shell);
    }
    (shell_of, shells)
}
