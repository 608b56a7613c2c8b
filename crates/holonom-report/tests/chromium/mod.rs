//! Pages opened in Chromium, or in a relative of it named in the environment variable `CHROMIUM`.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What checks in pages have in common; stands in front of them.
pub const TOOLS: &str = include_str!("../checks/tools.js");

/// What the checks in a page have left in #checks.
pub fn checks_in(dom: &str) -> Value {
    let found = dom.split_once(r#"id="checks">"#).and_then(|(_, rest)| rest.split_once("</script>"));
    let (json, _) = found.unwrap_or_else(|| panic!("the checks did not finish; the page ends with:\n{}", tail(dom, 2000)));
    serde_json::from_str(json).unwrap()
}

/// Width and height of a window, px.
pub const WINDOW: [u32; 2] = [1400, 1000];

/// The page as it is after everything in it has run, in a window of this width and height, px.
pub fn dump_dom(file: &Path, folder: &Path, [width, height]: [u32; 2]) -> String {
    let browser = std::env::var("CHROMIUM").unwrap_or_else(|_| "chromium".to_owned());
    let quiet = "--headless --no-sandbox --no-first-run --disable-background-networking --disable-component-update --disable-sync";
    // WebGL in software: a machine that runs tests has no graphics card.
    let software = "--disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --disable-dev-shm-usage";
    let output = Command::new(&browser)
        .args(quiet.split(' ').chain(software.split(' ')))
        .arg(format!("--user-data-dir={}", folder.join("profile").display()))
        .arg(format!("--window-size={width},{height}"))
        .args(["--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap_or_else(|e| panic!("cannot start `{browser}`: {e}\nThis test needs Chromium: apt install chromium"));
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !dom.is_empty(), "`{browser}` failed ({}):\n{}", output.status, tail(&errors, 4000));
    dom
}

fn tail(text: &str, length: usize) -> &str {
    &text[text.ceil_char_boundary(text.len().saturating_sub(length))..]
}
