//! The slowest small vibrations of mechanisms with many freedoms, beside closed forms.

mod common;

use std::f64::consts::{PI, TAU};

use common::model;
use holonom::analysis::{Modes, modes};

const COUNT: usize = 160;

/// Masses of 1 kg on a rail with springs of 100 N/m between them, and the first one's to the ground. Dampers are `damping` times as strong.
fn masses(damping: f64, is_tied: bool) -> Modes {
    let mut text = "gravity = [0, 0, 0]\n".to_string();
    for k in 0..COUNT {
        text += &format!(
            "[body.m{k}]\nmass = 1\nshape = {{ box = [0.1, 0.1, 0.1] }}\nposition = [{k}, 0, 0]\n\
             [joint.r{k}]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m{k}\"]\nat = [{k}, 0, 0]\naxis = [1, 0, 0]\n"
        );
        let before = if k > 0 { format!("m{}", k - 1) } else { "[-1, 0, 0]".into() };
        if k > 0 || is_tied {
            let before = if k > 0 { format!("\"{before}\"") } else { before };
            text += &format!(
                "[force.s{k}]\ntype = \"spring\"\nbetween = [{before}, \"m{k}\"]\nstiffness = 100\ndamping = {}\n",
                100.0 * damping
            );
        }
    }
    modes(&model(&text).system).unwrap()
}

/// Speeds of the masses, 1/s: those of a chain with one end that is free, or both.
fn speed(k: usize, is_tied: bool) -> f64 {
    let share = if is_tied { (2 * k - 1) as f64 / (4 * COUNT + 2) as f64 } else { k as f64 / (2 * COUNT) as f64 };
    20.0 * (PI * share).sin()
}

#[test]
fn masses_on_springs_have_those_of_a_chain() {
    let found = masses(0.0, true);
    assert!(found.modes.len() >= 40 && found.free == 0 && found.unsure == 0, "{} {}", found.modes.len(), found.free);
    assert_eq!(2 * found.modes.len() + found.faster, 2 * COUNT);
    for (k, mode) in (1..).zip(&found.modes) {
        let off = TAU * mode.frequency / speed(k, true) - 1.0;
        assert!(off.abs() < 1e-9 && mode.growth == 0.0, "{k}: {off:.1e} {}", mode.growth);
        assert_eq!(found.number(k - 1), k);
    }
}

#[test]
fn a_chain_that_is_free_has_two_that_are_zero() {
    let found = masses(0.0, false);
    assert!(found.modes.len() >= 39 && found.free == 2, "{} {}", found.modes.len(), found.free);
    for (k, mode) in (1..).zip(&found.modes) {
        let off = TAU * mode.frequency / speed(k, false) - 1.0;
        assert!(off.abs() < 1e-9, "{k}: {off:.1e}");
    }
}

/// s² + c ω² s + ω² = 0: of those above the critical damping the slower rates gather at 1/c, and what is slower than that is told.
#[test]
fn dampers_of_a_chain_damp_the_fast_ones() {
    let damping = 2.0 / speed(20, true);
    let found = masses(damping, true);
    let vibrating: Vec<_> = found.modes.iter().filter(|mode| mode.vibrates()).collect();
    assert!((9..20).contains(&vibrating.len()), "{}", vibrating.len());
    for (k, mode) in (1..).zip(vibrating) {
        let omega = speed(k, true);
        let decay = 0.5 * damping * omega * omega;
        let off = (mode.growth + decay).hypot(TAU * mode.frequency - (omega * omega - decay * decay).sqrt()) / omega;
        assert!(off < 1e-7, "{k}: {off:.1e}");
    }
}

/// A square beam bends to both sides alike, so that all but the torsional modes come in pairs.
#[test]
fn a_beam_in_space_has_pairs() {
    let found = modes(
        &model(
            "gravity = [0, 0, 0]\n[beam.b]\nfrom = [0, 0, 0]\nto = [2, 0, 0]\nelements = 60\nsection = { rectangle = [0.01, 0.01] }\n\
             modulus = 2e11\ndensity = 7800\n[joint.clamp]\ntype = \"fixed\"\nbetween = [\"ground\", \"b[0]\"]\nat = \"b[0]\"\n",
        )
        .system,
    )
    .unwrap();
    let unit = (2e11_f64 * 1e-4 / 12.0 / 7800.0).sqrt() / 4.0 / TAU;
    for (pair, root) in found.modes.chunks(2).zip([1.875_104_07_f64, 4.694_091_13, 7.854_757_44, 10.995_540_73]) {
        let [y, z] = [0, 1].map(|k| pair[k].frequency / (unit * root * root) - 1.0);
        // Shear and the inertia of the sections slow them down.
        assert!((-1e-3..1e-5).contains(&y) && (y - z).abs() < 1e-8, "{root}: {y:.1e} {z:.1e}");
    }
}
