//! STL files: binary, or text from `solid` to `endsolid`, as often as there are parts.

use super::{MeshError, Soup, coordinates, sound, unexpected};

/// Bytes before the count of triangles of a binary file; they mean nothing.
const HEADER: usize = 80;

/// Bytes before the first triangle of a binary file.
const START: usize = HEADER + 4;

/// Bytes of a triangle: normal, three corners (f32, little-endian), and two more.
const RECORD: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<Soup, MeshError> {
    // Headers of binary files may say `solid` too: such a file has the length that it announces, or at least zeros in it.
    let says_solid = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    match announced(bytes) {
        Some(count) if bytes.len() - START == count as usize * RECORD => binary(bytes),
        _ if says_solid && !bytes.contains(&0) => text(&String::from_utf8_lossy(bytes)),
        Some(announced) if bytes.len() - START < announced as usize * RECORD && !looks_like_text(bytes) => {
            Err(MeshError::Truncated { announced, found: (bytes.len() - START) / RECORD })
        }
        _ => Err(MeshError::NotMesh { missing: "it neither begins with `solid` nor has the length that a binary STL file announces" }),
    }
}

/// The number of triangles at its place in a binary file.
fn announced(bytes: &[u8]) -> Option<u32> {
    bytes.get(HEADER..START).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes)
}

fn looks_like_text(bytes: &[u8]) -> bool {
    !bytes.contains(&0) && std::str::from_utf8(bytes).is_ok()
}

/// Triangles of a binary file of the right length.
fn binary(bytes: &[u8]) -> Result<Soup, MeshError> {
    let mut soup = Soup::default();
    for (triangle, record) in bytes[START..].chunks_exact(RECORD).enumerate() {
        let number = |at: usize| f64::from(f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]));
        let corners = [12, 24, 36].map(|at| [number(at), number(at + 4), number(at + 8)]);
        if !corners.as_flattened().iter().copied().all(sound) {
            return Err(MeshError::NoNumber { triangle: triangle + 1 });
        }
        soup.add_corners(corners)?;
    }
    if soup.triangles.is_empty() {
        return Err(MeshError::NotMesh { missing: "it has no triangles" });
    }
    Ok(soup)
}

/// Where in a text the next line is.
#[derive(Clone, Copy)]
enum Within {
    File,
    Solid,
    Facet,
    Loop,
}

impl Within {
    fn name(self) -> &'static str {
        match self {
            Self::File => "the file",
            Self::Solid => "a solid: `endsolid` is missing",
            Self::Facet => "a facet",
            Self::Loop => "the loop of a facet",
        }
    }

    fn expected(self) -> &'static str {
        match self {
            Self::File => "`solid`",
            Self::Solid => "`facet` or `endsolid`",
            Self::Facet => "`outer loop` or `endfacet`",
            Self::Loop => "`vertex` or, after three of them, `endloop`",
        }
    }
}

/// Triangles of a text. Names and normals are not read: corners say more.
fn text(text: &str) -> Result<Soup, MeshError> {
    let mut soup = Soup::default();
    let mut within = Within::File;
    let mut corners = Vec::with_capacity(3);
    for (line, content) in (1..).zip(text.lines()) {
        let mut words = content.split_whitespace();
        let Some(first) = words.next() else {
            continue;
        };
        within = match (within, first.to_ascii_lowercase().as_str()) {
            (Within::File, "solid") | (Within::Facet, "endfacet") => Within::Solid,
            (Within::Solid, "facet") => Within::Facet,
            (Within::Solid, "endsolid") => Within::File,
            (Within::Facet, "outer") => Within::Loop,
            (Within::Loop, "vertex") if corners.len() < 3 => {
                corners.push(coordinates(&mut words, line)?);
                Within::Loop
            }
            (Within::Loop, "endloop") if corners.len() == 3 => {
                soup.add_corners([corners[0], corners[1], corners[2]])?;
                corners.clear();
                Within::Facet
            }
            _ => return Err(unexpected(line, content.trim(), within.expected())),
        };
    }
    match within {
        Within::File if soup.triangles.is_empty() => Err(MeshError::NotMesh { missing: "it has no facets" }),
        Within::File => Ok(soup),
        _ => Err(MeshError::Unfinished { within: within.name() }),
    }
}
