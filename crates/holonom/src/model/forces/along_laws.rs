//! Laws of a spring along an axis, whose length is an invariant itself: the formulas of `laws.rs` without its root.

use super::laws::{Energy, Force};
use crate::system::{Bend, Law, Reach, Response};

/// A formula of the length along an axis.
pub(super) struct Along<L>(pub L);

impl Law for Along<Energy> {
    fn bends(&self, value: &[f64], _rate: &[f64], _t: f64, note: &mut dyn FnMut(Bend)) {
        self.0.bends(value[0], note);
    }

    fn energy(&self, value: &[f64]) -> f64 {
        self.0.value(value[0])
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        let v = self.0.v(value[0]);
        (out.force[0], out.by_value[0][0]) = (v.v1, v.v2);
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let [start, end] = [reach.from[0], reach.to[0]];
        [out.force[0], out.by_value[0][0]] = self.0.average([start, end], end - start, start.abs().max(end.abs()));
    }
}

impl Law for Along<Force> {
    fn bends(&self, value: &[f64], rate: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        self.0.bends(value[0], rate[0], t, note);
    }

    fn conservative(&self) -> bool {
        false
    }

    fn may_supply(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], rate: &[f64], t: f64, out: &mut Response) {
        (out.force[0], out.by_value[0][0], out.by_rate[0][0]) = self.0.tension(value[0], rate[0], t);
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let [start, end] = [reach.from[0], reach.to[0]];
        let (tension, by_length, by_rate) = self.0.tension(0.5 * (start + end), (end - start) / reach.step, reach.middle);
        out.force[0] = tension;
        out.by_value[0][0] = 0.5 * by_length + by_rate / reach.step;
    }
}
