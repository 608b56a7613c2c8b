//! The page about a sweep: where points, cells and runs that failed stand in it.

use holonom_report::{SweepColumn, SweepKey, SweepReport, SweepRun};

fn run(number: usize, settings: &[String]) -> SweepRun {
    let (status, reason) = ("completed".to_string(), String::new());
    SweepRun { number: number as u64, settings: settings.to_vec(), status, stopped_at: None, reason }
}

fn page(is_grid: bool, keys: &[&str], runs: &[SweepRun], columns: &[SweepColumn]) -> String {
    let keys: Vec<SweepKey> = keys.iter().map(|name| SweepKey { name, is_logarithmic: false }).collect();
    let set = ["simulation.step=0.01".to_string()];
    let notes = ["`k` < 0".to_string()];
    let report =
        SweepReport { title: "A <sweep>", notes: &notes, model_text: "[point.\"<m>\"]", set: &set, is_grid, keys: &keys, columns, runs };
    let mut out = Vec::new();
    report.write(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn column<'a>(name: &'a str, values: Vec<Option<f64>>) -> SweepColumn<'a> {
    SweepColumn { name, unit: "N", values }
}

/// The numbers of an attribute of all elements of a kind.
fn attributes(page: &str, element: &str, attribute: &str) -> Vec<f64> {
    let begin = format!("<{element} ");
    let elements = page.split(&begin).skip(1).map(|rest| rest.split_once('>').unwrap().0);
    let attribute = format!("{attribute}=\"");
    elements.filter_map(|element| element.split_once(&attribute)?.1.split_once('"')?.0.parse().ok()).collect()
}

#[test]
fn one_key_has_a_curve_for_each_column() {
    // 0, 100, …, 400 and a tenth of that: the ends of both axes are round, so points lie on the diagonal of the field.
    let runs: Vec<SweepRun> = (0..5).map(|k| run(k + 1, &[(100 * k).to_string()])).collect();
    let values: Vec<Option<f64>> = (0..5).map(|k| Some(10.0 * f64::from(k))).collect();
    let page = page(true, &["parameters.k"], &runs, &[column("max(s.force)", values.clone()), column("other", values)]);
    assert_eq!(page.matches("<figure>").count(), 2);
    let (x, y) = (attributes(&page, "circle", "cx"), attributes(&page, "circle", "cy"));
    assert_eq!(x.len(), 10);
    let even = |places: &[f64]| places.windows(2).all(|pair| ((pair[1] - pair[0]) - (places[1] - places[0])).abs() < 0.2);
    assert!(even(&x[..5]) && even(&y[..5]) && x[1] > x[0] && y[1] < y[0], "{x:?} {y:?}");
    let (left, right) = (attributes(&page, "line class=\"grid\"", "x1")[0], attributes(&page, "line class=\"grid\"", "x2")[0]);
    assert!((x[0] - left).abs() < 0.1 && (x[4] - right).abs() < 0.1, "{x:?} {left} {right}");
    assert_eq!(page.matches("class=\"curve\"").count(), 2);
    assert!(page.contains("5 runs · 5 completed · grid of parameters.k") && page.contains("run 3, parameters.k = 200: 20<"));
    assert!(page.contains("<li><strong>note:</strong> `k` &lt; 0</li>"));
    assert!(page.contains("max(s.force) <small>N</small>") && page.contains("simulation.step=0.01"));
}

#[test]
fn columns_that_are_the_same_in_all_runs_are_told_below() {
    let runs: Vec<SweepRun> = (0..3).map(|k| run(k + 1, &[k.to_string()])).collect();
    let columns = [("constant", [2.5; 3]), ("noise", [1e-15, -2e-15, 0.0]), ("other", [1.0, 2.0, 10.0])];
    let columns: Vec<SweepColumn> = columns.into_iter().map(|(name, values)| column(name, values.map(Some).to_vec())).collect();
    let page = page(true, &["k"], &runs, &columns);
    assert_eq!((page.matches("<figure>").count(), page.matches("<figcaption>other").count()), (1, 1));
    assert!(
        page.contains("The same in all runs: <code>constant</code> = 2.5 N, <code>noise</code> = 0 N.") && page.contains("sorted by other")
    );
    // A single run has nothing to be compared with.
    let alone = [column("constant", vec![Some(2.5)])];
    let page = self::page(true, &["k"], &runs[..1], &alone);
    assert!(page.contains("<figcaption>constant") && !page.contains("The same in all runs"));
}

#[test]
fn runs_that_fail_break_the_curve_and_stand_last_with_their_reasons() {
    let mut runs: Vec<SweepRun> = (0..5).map(|k| run(k + 1, &[k.to_string()])).collect();
    (runs[2].status, runs[2].reason, runs[2].stopped_at) = ("stopped".into(), "no <convergence>".into(), Some(1.5));
    let values = [4.0, 3.0, 1e9, 1.0, 2.0].map(Some).to_vec();
    let page = page(true, &["k"], &runs, &[column("c", values)]);
    let path = page.split_once("class=\"curve\" d=\"").unwrap().1.split_once('"').unwrap().0;
    assert_eq!((path.matches('M').count(), path.matches('L').count()), (2, 2), "{path}");
    assert_eq!(page.matches("class=\"failed\" d=").count(), 1);
    assert!(page.contains("run 3, k = 2 stopped at 1.5 s: no &lt;convergence&gt;"));
    let body = page.split_once("<tbody>").unwrap().1;
    let order: Vec<&str> = body.split("<th scope=\"row\" class=\"number\">").skip(1).map(|rest| rest.split_once('<').unwrap().0).collect();
    assert_eq!(order, ["4", "5", "2", "1", "3"], "sorted by the first column, what failed last");
    assert_eq!(body.matches("<tr class=\"failed\">").count(), 1);
    assert!(!page.contains("1000000000</text>"), "the axis holds the runs that completed");
}

#[test]
fn two_keys_have_a_map() {
    let settings = |k: usize| [(k / 3).to_string(), ["c", "a", "b"][k % 3].to_string()];
    let mut runs: Vec<SweepRun> = (0..6).map(|k| run(k + 1, &settings(k))).collect();
    (runs[5].status, runs[5].reason) = ("refused".into(), "too large".into());
    let values = [1.0, 2.0, 3.0, 4.0, 5.0, f64::NAN].map(|v| Some(v).filter(|v| v.is_finite())).to_vec();
    let page = page(true, &["up", "right"], &runs, &[column("c", values)]);
    let cells: Vec<&str> = page.split("<rect ").skip(1).filter(|rest| rest.contains("<title>run ")).collect();
    assert_eq!((cells.len(), page.matches("<figure>").count()), (5, 1));
    let of = |told: &str| *cells.iter().find(|cell| cell.contains(told)).unwrap_or_else(|| panic!("{told} in {cells:?}"));
    let (least, most) = (of("run 1, up = 0, right = c: 1<"), of("run 5, up = 1, right = a: 5<"));
    assert!(least.contains("#440154") && most.contains("#fde725"), "{least} {most}");
    let at = |cell: &str| (attributes(&format!("<rect {cell}"), "rect", "x")[0], attributes(&format!("<rect {cell}"), "rect", "y")[0]);
    assert!(at(most).0 > at(least).0 && at(most).1 < at(least).1, "numbers rise to the right, words upwards in their order");
    assert!(page.contains("run 6, up = 1, right = b refused: too large"));
}

/// Labels of colours and of keys have as many digits as tell them apart, and no more.
#[test]
fn labels_of_a_narrow_range_are_told_apart() {
    let labels = |low: f64, high: f64, keys: [&str; 2]| {
        let runs: Vec<SweepRun> = (0..4).map(|k| run(k + 1, &[keys[k / 2].into(), k.to_string()])).collect();
        let values = [low, high, low, high].map(Some).to_vec();
        let page = page(true, &["up", "right"], &runs, &[column("c", values)]);
        let svg = page.split_once("<svg class=\"chart\"").unwrap().1.split_once("</svg>").unwrap().0.to_string();
        svg.match_indices("<text ")
            .map(|(at, _)| svg[at..].split_once('>').unwrap().1.split_once('<').unwrap().0.to_string())
            .collect::<Vec<_>>()
    };
    let has =
        |labels: &[String], wanted: [&str; 5]| assert!(wanted.iter().all(|one| labels.iter().any(|label| label == one)), "{labels:?}");
    has(&labels(1.0, 2.0, ["0.1", "0.2"]), ["0.1", "0.2", "1", "1.5", "2"]);
    has(&labels(9.81, 9.8108, ["20.001", "20.004"]), ["20.001", "20.004", "9.81", "9.8104", "9.8108"]);
    has(&labels(9.810001, 9.810003, ["20.001", "20.004"]), ["20.001", "20.004", "9.810001", "9.810002", "9.810003"]);
}

#[test]
fn samples_are_points_over_each_key() {
    let runs: Vec<SweepRun> = (0..50).map(|k| run(k + 1, &[(k * k % 7).to_string(), ["x", "y"][k % 2].into()])).collect();
    let values: Vec<Option<f64>> = (0..50).map(|k| Some(f64::from(k))).collect();
    let page = page(false, &["a", "b"], &runs, &[column("c", values.clone()), column("d", values)]);
    assert_eq!((page.matches("<figure>").count(), page.matches("<circle").count(), page.matches("class=\"curve\"").count()), (4, 200, 0));
    assert!(page.contains("random samples of a, b"));
}

#[test]
fn many_runs_and_columns_stay_a_page_that_says_what_it_leaves_out() {
    let names: Vec<String> = (0..60).map(|k| format!("m{k}.x")).collect();
    let runs: Vec<SweepRun> = (0..20_000).map(|k| run(k + 1, &[format!("{}", f64::from(k as u32) / 7.0)])).collect();
    let values: Vec<Option<f64>> = (0..20_000).map(|k| Some(f64::from(k).sin())).collect();
    let columns: Vec<SweepColumn> = names.iter().map(|name| column(name, values.clone())).collect();
    for is_grid in [true, false] {
        let page = page(is_grid, &["k"], &runs, &columns);
        assert!(page.len() < 8_000_000, "{} bytes", page.len());
        for told in ["2000 of 20000 runs", "24 of 60 plots", "1000 of 20000 runs and 40 of 60 columns"] {
            assert!(page.contains(told), "{told}");
        }
    }
    let runs: Vec<SweepRun> = (0..40_000).map(|k| run(k + 1, &[(k / 200).to_string(), (k % 200).to_string()])).collect();
    let page = page(true, &["a", "b"], &runs, &[column("c", (0..40_000).map(|k| Some(f64::from(k))).collect())]);
    assert!(page.matches("<rect ").count() < 64 * 64 + 40 && page.contains("at most 64 values"), "{}", page.matches("<rect ").count());
    assert!(page.contains("run 1, ") && page.contains("run 40000, "), "the corners are in the map");
}

#[test]
fn nothing_to_plot_is_no_fault_and_foreign_text_stays_text() {
    let nasty = "</text></svg><script>alert(1)</script>";
    let mut failed = run(1, &[nasty.to_string()]);
    (failed.status, failed.reason) = ("refused".into(), nasty.into());
    for (runs, columns) in [
        (vec![], vec![]),
        (vec![], vec![column(nasty, vec![])]),
        (vec![failed], vec![column(nasty, vec![None])]),
        (vec![run(1, &[nasty.to_string()])], vec![column(nasty, vec![Some(f64::INFINITY)])]),
        (vec![run(1, &[nasty.to_string()])], vec![column(nasty, vec![Some(0.0)])]),
    ] {
        for is_grid in [true, false] {
            let page = page(is_grid, &[nasty], &runs, &columns);
            assert!(!page.contains("<script") && !page.contains("NaN") && page.contains("A &lt;sweep&gt;"), "{page}");
            assert!(page.ends_with("</html>\n"));
        }
    }
}
