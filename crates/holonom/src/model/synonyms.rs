//! What other programs, and people, call the keys, kinds and names of a model file.

use super::GROUND;

/// Words of a model file, each with those that mean the same elsewhere. A word may stand behind several: the first of these that is known counts.
const SYNONYMS: &[(&str, &[&str])] = &[
    // Names.
    (GROUND, &["world", "base", "fixed", "inertial", "inertial-frame", "earth", "origin", "environment"]),
    // Tables of the model.
    ("point", &["node", "particle", "marker", "mass-point"]),
    ("body", &["link", "rigid-body", "bodies", "part", "segment", "on"]),
    ("bar", &["rod", "truss"]),
    ("beam", &["flexible", "flexible-beam", "boom"]),
    ("drive", &["motor", "actuator", "motion", "driver"]),
    ("force", &["load"]),
    ("parameters", &["constants", "variables", "const", "vars"]),
    ("simulation", &["settings", "solver", "analysis", "integration"]),
    ("start", &["initial", "initial-conditions", "initial-state"]),
    ("measure", &["sensor", "request", "probe"]),
    // Kinds of joints.
    ("revolute", &["hinge", "pin", "pinned", "rotational", "rotary", "rotation", "continuous", "turning"]),
    ("prismatic", &["slider", "sliding", "slide", "translational", "translation", "rail"]),
    ("spherical", &["ball", "ball-and-socket", "socket"]),
    ("fixed", &["weld", "welded", "rigid", "clamp", "clamped", "lock", "locked"]),
    ("universal", &["cardan", "hooke", "hookes", "u", "gimbal"]),
    ("constant-velocity", &["cv", "homokinetic", "rzeppa"]),
    ("screw", &["helical", "helix", "spindle", "lead-screw", "ball-screw", "nut"]),
    ("point-on-line", &["inline"]),
    ("point-on-plane", &["inplane"]),
    ("pulley", &["belt", "chain"]),
    ("rack-and-pinion", &["rack", "pinion"]),
    ("linear", &["coupler", "coupling", "differential", "planetary"]),
    ("gear", &["gearbox", "worm", "worm-gear", "bevel", "mesh", "transmission"]),
    ("cam", &["follower", "geneva"]),
    ("rolling", &["wheel", "disc", "disk", "tyre", "tire"]),
    // Kinds of forces.
    ("spring", &["damper", "spring-damper", "dashpot", "tsda", "shock-absorber"]),
    ("torsion", &["torsion-spring", "torsional-spring", "rotational-spring", "rsda"]),
    ("rope", &["cable", "string", "tendon", "wire", "cord", "winch", "hoist"]),
    ("stop", &["limit", "bumper", "buffer", "end-stop", "contact", "impact", "collision"]),
    ("torque", &["moment", "couple"]),
    ("friction", &["coulomb", "dry-friction", "brake", "clutch"]),
    ("bushing", &["mount", "rubber", "rubber-mount"]),
    // Kinds of drives.
    ("angle", &["rotation", "rotational", "angular"]),
    // Keys.
    ("between", &["bodies", "connects", "parts", "ends", "points"]),
    ("at", &["position", "location", "anchor", "point", "place"]),
    ("axis", &["direction"]),
    ("position", &["pos", "origin", "location", "com", "xyz"]),
    ("orientation", &["rotation", "rot", "quaternion", "attitude", "angle", "euler", "rpy"]),
    ("velocity", &["vel"]),
    ("angular_velocity", &["omega", "angvel"]),
    ("com", &["center-of-mass", "centre-of-mass", "cog", "cg"]),
    ("inertia", &["moment-of-inertia", "moments", "moi"]),
    ("shape", &["geometry", "visual"]),
    ("effort", &["force", "torque", "moment", "value", "magnitude", "motor", "actuator", "controller", "pid", "servo"]),
    ("speed", &["velocity"]),
    ("angle_rate", &["rate", "angular-velocity", "omega", "w", "spin"]),
    ("displacement_rate", &["rate"]),
    ("displacement", &["position", "stroke", "travel", "translation"]),
    ("stiffness", &["k", "rate", "spring-constant"]),
    ("damping", &["c", "d", "damping-coefficient"]),
    ("rest_length", &["l0", "length", "free-length", "natural-length", "unstretched-length"]),
    ("profile", &["motion", "function", "trajectory", "value", "angle", "displacement", "distance"]),
    ("end", &["tend", "tstop", "tmax", "tfinal", "tf", "duration", "stop-time", "end-time", "final-time"]),
    ("step", &["dt", "h", "timestep", "step-size", "max-step"]),
    ("value", &["formula", "expression", "expr", "function"]),
    ("method", &["solver", "scheme"]),
    ("accuracy", &["rtol", "atol", "reltol", "abstol", "tol"]),
    ("max_iterations", &["maxiter", "max-newton-iterations"]),
];

/// A word without what is written this way or that.
fn plain(word: &str) -> String {
    let letters: String = word.chars().filter(|c| !matches!(c, '-' | '_' | ' ')).flat_map(char::to_lowercase).collect();
    letters.strip_suffix("joint").filter(|rest| !rest.is_empty()).unwrap_or(&letters).to_string()
}

/// The known word that means the same as `word`, which is called so elsewhere or is written a little otherwise.
pub fn same<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = plain(word);
    let rank = |known: &str| {
        let means = |&(here, words): &(&str, &[&str])| here == known && words.iter().any(|word| plain(word) == wanted);
        if plain(known) == wanted { Some(0) } else { SYNONYMS.iter().position(means).map(|k| k + 1) }
    };
    known.into_iter().filter_map(|known| Some((rank(known)?, known))).min_by_key(|(rank, _)| *rank).map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_other_programs_are_known() {
        assert_eq!(same("Slider", ["linear", "prismatic"]), Some("prismatic"));
        assert_eq!(same("hinge_joint", ["spherical", "revolute"]), Some("revolute"));
        assert_eq!(same("t_end", ["step", "end"]), Some("end"));
        assert_eq!(same("solver", ["order", "method"]), Some("method"));
        assert_eq!(same("world", ["rotor", "ground"]), Some("ground"));
        assert_eq!(same("world", ["rotor"]), None);
        assert_eq!(same("joint", ["revolute"]), None);
    }

    #[test]
    fn no_word_stands_for_itself_or_twice_for_one() {
        for (here, words) in SYNONYMS {
            assert!(SYNONYMS.iter().filter(|(other, _)| other == here).count() == 1, "{here} comes twice");
            for (k, word) in words.iter().enumerate() {
                assert!(plain(word) != plain(here) && words[..k].iter().all(|other| plain(other) != plain(word)), "{here}: {word}");
            }
        }
    }
}
