use holonom::simulation::{Choice, Method, Simulation, Verdict};
use holonom::system::{Place, System, SystemBuilder};
fn four_bar(n: usize) -> System {
    let mut b = SystemBuilder::new(2, [0.0, -9.81, 0.0]);
    let g: Vec<Place> = (0..=n).map(|i| Place::Fixed([i as f64, 0.0, 0.0])).collect();
    let p: Vec<Place> = (0..=n).map(|i| Place::Node(b.free_node([i as f64, 1.0, 0.0], [1.0, 0.0, 0.0]))).collect();
    let bars: Vec<(Place, Place)> = (0..=n).map(|i| (g[i], p[i])).chain((0..n).map(|i| (p[i], p[i + 1]))).collect();
    for (k, (x, y)) in bars.into_iter().enumerate() {
        b.mass(x, x, 1.0 / 3.0);
        b.mass(y, y, 1.0 / 3.0);
        b.mass(x, y, 1.0 / 6.0);
        let d = b.square(&[(y, 1.0), (x, -1.0)]);
        b.constant_row(format!("{k}"), d, 0.5);
    }
    b.build()
}
#[test]
fn probe() {
    for (n, exact) in [(1, [0.478385057760971, 0.878150178791209]), (10, [0.204353560989771, 0.978897145828304]), (40, [0.180512226686728, 0.983572740582312])] {
        for h in [1e-2, 1e-3] {
            for name in ["conserving", "conserving-ggl"] {
                let system = four_bar(n);
                let mut s = Simulation::new(&system, Method::resolve(&Choice { method: Some(name.into()), ..Choice::default() }).unwrap(), h).unwrap();
                let t = std::time::Instant::now();
                let status = s.run(10.0, &mut |_: &Simulation<'_>| Verdict::GoOn);
                let us = t.elapsed().as_secs_f64() * 1e6 / s.steps().max(1) as f64;
                let x = &s.state().x;
                println!("{n} {h} {name} {status:?} err {:.2e} drift {:.1e} {:?} {:?} us {us:.2}", ((x[0] - exact[0]).powi(2) + (x[1] - exact[1]).powi(2)).sqrt(), s.audit().energy_summary().max_drift, s.audit().work_summary(s.steps()), s.audit().violation_summary());
            }
        }
    }
}
