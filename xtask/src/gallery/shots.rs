//! What is taken of each model: the run, the moment, and where the camera is.

/// Width and height of the pictures, px.
pub const SIZE: [u32; 2] = [640, 420];

/// One picture.
pub struct Shot {
    pub name: &'static str,
    /// What `holonom run` is told beside the model.
    pub run: &'static [&'static str],
    /// s.
    pub time: f64,
    /// How far the camera goes around the mechanism, clockwise seen from above, and upwards, degrees.
    pub turn: [f64; 2],
    /// How many times as large the mechanism is shown.
    pub closer: f64,
    /// How far the mechanism is moved to the right and down, px.
    pub shift: [f64; 2],
}

/// A picture from where the report looks at first.
const fn at(name: &'static str, time: f64) -> Shot {
    Shot { name, run: &[], time, turn: [0.0; 2], closer: 1.0, shift: [0.0; 2] }
}

/// The same, nearer, and moved to the right and down.
const fn near(name: &'static str, time: f64, closer: f64, shift: [f64; 2]) -> Shot {
    Shot { closer, shift, ..at(name, time) }
}

/// One of a joint: its model is run for a second.
const fn joint(name: &'static str, time: f64) -> Shot {
    Shot { run: &["--end", "1", "--step", "0.01"], ..at(name, time) }
}

/// One of a joint that holds nothing up: without gravity it stays in the picture.
const fn floating(name: &'static str, time: f64) -> Shot {
    Shot { run: &["--end", "0.6", "--step", "0.01", "--set", "gravity=[0,0,0]"], ..at(name, time) }
}

/// `examples/NAME.toml`.
pub const GALLERY: &[Shot] = &[
    at("simple-pendulum", 0.6),
    at("double-pendulum", 1.0),
    near("spherical-compound-pendulum", 0.6, 1.4, [0.0, -20.0]),
    at("spring-pendulum", 0.4),
    at("chain", 1.0),
    at("four-bar", 1.0),
    at("car-axis", 1.0),
    at("andrews", 0.02),
    near("bricard", 1.0, 1.2, [0.0, 0.0]),
    near("flexible-four-bar", 6.0, 1.2, [0.0, 0.0]),
    near("flyball-governor", 1.25, 1.3, [0.0, 0.0]),
    near("slider-crank", 0.3, 1.1, [0.0, -40.0]),
    at("spatial-four-bar", 0.5),
    near("heavy-top", 0.3, 1.4, [0.0, 0.0]),
    at("free-body", 6.0),
    near("rolling-disc", 2.0, 1.5, [-110.0, -60.0]),
    at("stewart-platform", 2.0),
    at("jansen-linkage", 3.0),
    near("robot-arm", 1.5, 1.5, [0.0, -85.0]),
    at("differential", 1.0),
    at("suspension", 0.6),
];

/// The models in the sections of docs/joints.md.
pub const JOINTS: &[Shot] = &[
    Shot { closer: 0.9, ..joint("spherical", 0.3) },
    joint("revolute", 0.5),
    joint("prismatic", 0.5),
    floating("cylindrical", 0.5),
    Shot { closer: 0.85, shift: [0.0, 20.0], ..joint("universal", 0.3) },
    floating("planar", 0.4),
    Shot { closer: 0.75, ..floating("fixed", 0.3) },
    joint("screw", 0.4),
    Shot { closer: 0.8, ..floating("constant-velocity", 0.3) },
    joint("point-on-line", 0.3),
    joint("point-on-plane", 0.4),
    joint("point-on-curve", 0.5),
    floating("parallel", 0.3),
    floating("perpendicular", 0.3),
    floating("orientation", 0.3),
    joint("distance", 0.3),
    joint("revolute-spherical", 0.3),
    floating("generic", 0.5),
    joint("rolling", 0.8),
    joint("gear", 0.3),
    joint("rack-and-pinion", 0.3),
    joint("pulley", 0.3),
    joint("linear", 0.3),
    joint("cam", 0.2),
];
