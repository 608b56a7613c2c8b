//! A report in headless Chromium, of which nothing but the picture is shown.

use std::path::Path;
use std::process::Command;

use super::shots::{SIZE, Shot};

/// Where the page leaves its picture.
const MARK: &str = "id=\"picture\">data:image/png;base64,";

/// The report with what puts it into position: the moment, and the camera as a hand on the mouse would move it.
pub fn page(report: &str, shot: &Shot) -> Result<String, String> {
    let [width, height] = SIZE;
    // What waits for the screen is drawn at once: the page is read as soon as it is loaded.
    let head_script = "<script>(() => {
  const [later, depth] = [window.requestAnimationFrame.bind(window), { now: 0 }];
  window.requestAnimationFrame = (draw) => {
    if (depth.now > 0) return later(draw);
    depth.now++;
    draw(performance.now());
    depth.now--;
    return 0;
  };
})();</script>";
    let style = format!(
        "<style>.stage{{position:fixed!important;left:0;top:0;width:{width}px!important;height:{height}px!important;border:0!important}}</style>"
    );
    // A drag over the height of the picture is a whole turn; a notch of the wheel is 5 %.
    let [about, up] = shot.turn.map(|degrees| degrees / 360.0 * f64::from(height));
    let wheel = shot.closer.ln() / 0.95_f64.ln() * 100.0;
    let [right, down] = shot.shift;
    let script = format!(
        r#"<script>
const canvas = document.querySelector(".stage canvas");
canvas.setPointerCapture = canvas.releasePointerCapture = () => {{}};
const send = (target, kind, x, y, button) => target.dispatchEvent(new PointerEvent(kind, {{
  pointerId: 1, pointerType: "mouse", button, buttons: 1 << button, clientX: 300 + x, clientY: 200 + y, bubbles: true }}));
const drag = (x, y, button) => {{
  send(canvas, "pointerdown", 0, 0, button);
  send(canvas, "pointermove", x, y, button);
  send(canvas, "pointerup", x, y, button);
}};
if ({turns}) drag({about}, {up}, 0);
if ({shifts}) drag({right}, {down}, 2);
if ({zooms}) canvas.dispatchEvent(new WheelEvent("wheel", {{ deltaY: {wheel}, clientX: {width} / 2, clientY: {height} / 2 }}));
holonom.setTime({time});
const place = document.createElement("pre");
place.id = "picture";
place.textContent = canvas.toDataURL("image/png");
document.body.append(place);
</script>"#,
        turns = shot.turn != [0.0; 2],
        shifts = shot.shift != [0.0; 2],
        zooms = shot.closer != 1.0,
        time = shot.time,
    );
    let (head, rest) = report.split_once("</head>").ok_or("the report has no head")?;
    let (body, end) = rest.rsplit_once("</body>").ok_or("the report has no body")?;
    Ok(format!("{head}{head_script}{style}</head>{body}{script}</body>{end}"))
}

/// The picture that a page makes, as a PNG file.
pub fn picture(page: &Path, profile: &Path) -> Result<Vec<u8>, String> {
    let browser = std::env::var("CHROMIUM").unwrap_or_else(|_| "chromium".to_owned());
    let quiet = "--headless --no-sandbox --no-first-run --disable-background-networking --disable-component-update --disable-sync";
    // WebGL in software: the same picture on every machine.
    let software = "--disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --disable-dev-shm-usage";
    let output = Command::new(&browser)
        .args(quiet.split(' ').chain(software.split(' ')))
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(["--window-size=1000,800", "--dump-dom"])
        .arg(format!("file://{}", page.display()))
        .output()
        .map_err(|error| format!("`{browser}` does not start: {error}; pictures need Chromium"))?;
    let dom = String::from_utf8_lossy(&output.stdout);
    let data = dom.split_once(MARK).and_then(|(_, rest)| rest.split_once("</pre>"));
    let (data, _) = data.ok_or_else(|| format!("{}: the page made no picture", page.display()))?;
    decode(data).ok_or_else(|| format!("{}: the picture is no base64", page.display()))
}

/// Base64, with padding.
fn decode(text: &str) -> Option<Vec<u8>> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => Some(c - b'A'),
        b'a'..=b'z' => Some(c - b'a' + 26),
        b'0'..=b'9' => Some(c - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    let digits: Vec<u32> = text.trim_end_matches('=').bytes().map(|c| digit(c).map(u32::from)).collect::<Option<_>>()?;
    let mut bytes = Vec::with_capacity(digits.len() * 3 / 4);
    for four in digits.chunks(4) {
        let bits = four.iter().enumerate().fold(0, |bits, (k, digit)| bits | digit << (18 - 6 * k));
        bytes.extend((1..four.len()).map(|k| (bits >> (24 - 8 * k)) as u8));
    }
    Some(bytes)
}
