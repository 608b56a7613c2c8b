//! Makes foreign text harmless: names and model files may contain anything.

/// For text and attribute values.
pub fn html(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            _ => safe.push(c),
        }
    }
    safe
}

/// For JSON inside a `<script>` element, where `</script>` and `<!--` would end or derail it. In JSON these characters occur only
/// inside strings, and there `\u003c` means the same.
pub fn json_in_script(json: &str) -> String {
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn html_cannot_break_out() {
        assert_eq!(html("<b a=\"x\" c='y'>&amp;</b>"), "&lt;b a=&quot;x&quot; c=&#39;y&#39;&gt;&amp;amp;&lt;/b&gt;");
    }

    #[test]
    fn json_keeps_its_meaning() {
        let text = "</script><!-- & \u{2028} \"";
        let json = json_in_script(&serde_json::to_string(text).unwrap());
        assert!(!json.contains('<') && !json.contains('>') && !json.contains('&'));
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), text);
    }
}
