//! Wavefront OBJ files: of their lines, `v` and `f` are read.

use super::{MeshError, Soup, coordinates, unexpected};

pub(super) fn read(bytes: &[u8]) -> Result<Soup, MeshError> {
    let text = String::from_utf8_lossy(bytes);
    let mut soup = Soup::default();
    for (line, content) in (1..).zip(text.lines()) {
        let mut words = content.split('#').next().unwrap_or("").split_whitespace();
        match words.next() {
            // A weight or a colour may follow.
            Some("v") => soup.vertices.push(coordinates(&mut words, line)?),
            Some("f") => add_face(&mut soup, words, line)?,
            _ => (),
        }
    }
    match (soup.vertices.is_empty(), soup.triangles.is_empty()) {
        (true, _) => Err(MeshError::NotMesh { missing: "it has no vertices (lines with `v`)" }),
        (_, true) => Err(MeshError::NotMesh { missing: "it has no faces (lines with `f`)" }),
        _ => Ok(soup),
    }
}

/// Adds the fan of a polygon around its first corner; integrals over a flat one come out right even if it is not convex.
fn add_face<'a>(soup: &mut Soup, words: impl Iterator<Item = &'a str>, line: usize) -> Result<(), MeshError> {
    let (mut corners, mut first, mut last) = (0, 0, 0);
    for word in words {
        let corner = vertex(word, soup.vertices.len(), line)?;
        match corners {
            0 => first = corner,
            1 => (),
            _ => soup.add([first, last, corner])?,
        }
        last = corner;
        corners += 1;
    }
    if corners < 3 { Err(unexpected(line, &format!("a face of {corners} vertices"), "a face of three or more")) } else { Ok(()) }
}

/// The vertex of a word such as `3`, `3/1`, `3//2` or `-1`, the last one above.
fn vertex(word: &str, vertices: usize, line: usize) -> Result<u32, MeshError> {
    let number = word.split('/').next().unwrap_or("");
    let vertex: i64 = number.parse().map_err(|_| unexpected(line, word, "the number of a vertex"))?;
    let index = match vertex {
        1.. => u32::try_from(vertex - 1).ok(),
        _ => isize::try_from(vertex).ok().and_then(|back| vertices.checked_add_signed(back)?.try_into().ok()),
    };
    index.filter(|&index| (index as usize) < vertices).ok_or(MeshError::NoVertex { line, vertex, vertices })
}
