//! Small meshes in both formats, other readers and writers as witnesses, and bytes that mean harm.

use std::io::Cursor;

use super::*;

const BOX_OBJ: &str = "\
# a box of 1 × 2 × 3 with its least corner at the origin
mtllib box.mtl
o box
v 0 0 0
v 1 0 0 1.0
v 1 2 0 0.5 0.5 0.5
v 0 2 0
v 0 0 3
v 1 0 3
v 1 2 3
v 0 2 3
vt 0 0
vn 0 0 1
usemtl steel
s off
f 4 3 2 1
f 5/1 6/1 7/1 8/1   # texture
f 1//1 2//1 6//1 5//1
f 2/1/1 3/1/1 7/1/1 6/1/1
f -6 -5 -1 -2
g last
f 4 1 5
f 4 5 8
";

fn box_mesh() -> Mesh {
    read_mesh("box.obj", BOX_OBJ.as_bytes()).unwrap()
}

/// Corners of every triangle.
fn corners(mesh: &Mesh) -> Vec<[[f64; 3]; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|vertex| mesh.vertices[vertex as usize])).collect()
}

fn facet(corners: &[[f64; 3]; 3]) -> String {
    let vertices: String = corners.iter().map(|[x, y, z]| format!("      vertex {x:e} {y:e} {z:e}\n")).collect();
    format!("  facet normal nan nan nan\n    outer loop\n{vertices}    endloop\n  endfacet\n")
}

fn ascii_stl(mesh: &Mesh) -> String {
    let facets: String = corners(mesh).iter().map(facet).collect();
    format!("solid\n{facets}endsolid\n")
}

/// As another program writes it.
fn binary_stl(mesh: &Mesh) -> Vec<u8> {
    let vertex = |place: [f64; 3]| stl_io::Vertex::new(place.map(|c| c as f32));
    let triangle = |corners: &[[f64; 3]; 3]| stl_io::Triangle { normal: stl_io::Normal::default(), vertices: corners.map(vertex) };
    let triangles: Vec<_> = corners(mesh).iter().map(triangle).collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, triangles.iter()).unwrap();
    bytes
}

fn told(name: &str, bytes: impl AsRef<[u8]>) -> String {
    read_mesh(name, bytes.as_ref()).unwrap_err().to_string()
}

#[test]
fn every_format_of_a_box_gives_the_box() {
    let mesh = box_mesh();
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (8, 12));
    assert_eq!(mesh.flaw(), None);
    assert!((mesh.volume() - 6.0).abs() < 1e-14);
    let found = mesh.properties(12.0);
    for (k, (centre, moment)) in [(0.5, 13.0), (1.0, 10.0), (1.5, 5.0)].into_iter().enumerate() {
        assert!((found.centre[k] - centre).abs() < 1e-15 && (found.inertia[k][k] - moment).abs() < 1e-14);
    }
    let ascii = ascii_stl(&mesh);
    for (name, bytes) in [
        ("box.stl", ascii.clone().into_bytes()),
        ("BOX.STL", ascii.to_uppercase().replace('\n', "\r\n").into_bytes()),
        ("box.v2.stl", binary_stl(&mesh)),
    ] {
        let read = read_mesh(name, &bytes).unwrap();
        assert_eq!(corners(&read), corners(&mesh), "{name}");
        assert_eq!(read.vertices.len(), 8);
    }
}

#[test]
fn other_readers_see_the_same_triangles() {
    let mesh = box_mesh();
    let named = ascii_stl(&mesh).replacen("solid", "solid box", 1).replace("nan", "0");
    let other = stl_io::read_stl(&mut Cursor::new(&named)).unwrap();
    let seen: Vec<_> = other.into_triangle_vec().iter().map(|triangle| triangle.vertices.map(|vertex| vertex.0.map(f64::from))).collect();
    assert_eq!(corners(&read_mesh("box.stl", named.as_bytes()).unwrap()), seen);

    // It takes no comment after a face, and colours for all vertices or for none.
    let plain = BOX_OBJ.replace("# texture", "").replace("0.5 0.5 0.5", "");
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(plain), &options, |_| Ok(Default::default())).unwrap();
    let place = |mesh: &tobj::Mesh, k: u32| std::array::from_fn(|i| mesh.positions[3 * k as usize + i]);
    let seen: Vec<[[f64; 3]; 3]> = models
        .iter()
        .flat_map(|model| model.mesh.indices.chunks(3).map(|of| [of[0], of[1], of[2]].map(|k| place(&model.mesh, k))))
        .collect();
    assert_eq!(corners(&mesh), seen);
}

#[test]
fn all_solids_of_a_file_are_read() {
    let mesh = box_mesh();
    let mut other = mesh.clone();
    other.vertices.iter_mut().for_each(|vertex| vertex[0] += 5.0);
    let both = read_mesh("two.stl", format!("{}\n{}", ascii_stl(&mesh), ascii_stl(&other)).as_bytes()).unwrap();
    assert_eq!((both.flaw(), both.triangles.len()), (None, 24));
    assert!((both.volume() - 12.0).abs() < 1e-13);
}

#[test]
fn a_binary_file_may_call_itself_solid_and_a_text_be_no_unicode() {
    let mesh = box_mesh();
    let mut bytes = binary_stl(&mesh);
    bytes[..12].copy_from_slice(b"solid part\r\n");
    assert_eq!(corners(&read_mesh("part.stl", &bytes).unwrap()), corners(&mesh));
    let text = ascii_stl(&mesh).replacen("solid", "solid K?rper", 1);
    let latin: Vec<u8> = text.bytes().map(|byte| if byte == b'?' { 0xf6 } else { byte }).collect();
    assert_eq!(read_mesh("part.stl", &latin).unwrap(), mesh);
}

#[test]
fn near_vertices_are_welded_and_what_is_left_of_slivers_is_dropped() {
    let mesh = box_mesh();
    let mut shaken = corners(&mesh);
    let mut shift = 0.0;
    for corner in shaken.as_flattened_mut().as_flattened_mut() {
        shift = (shift + 0.37e-9) % 1e-9;
        *corner += shift;
    }
    // A needle along an edge, which is shorter than what is welded.
    shaken.push([[1.0, 2.0, 0.0], [1.0 + 1e-9, 2.0, 0.0], [1.0, 2.0, 3.0]]);
    let text = format!("solid shaken\n{}endsolid", shaken.iter().map(facet).collect::<String>());
    let welded = read_mesh("shaken.stl", text.as_bytes()).unwrap();
    assert_eq!((welded.flaw(), welded.vertices.len(), welded.triangles.len()), (None, 8, 12));
    assert!((welded.volume() - 6.0).abs() < 1e-7);
    // What is farther apart is not.
    shaken[0][0][0] += 1e-7;
    let text = format!("solid apart\n{}endsolid", shaken.iter().map(facet).collect::<String>());
    assert_eq!(read_mesh("apart.stl", text.as_bytes()).unwrap().vertices.len(), 9);
}

#[test]
fn a_mesh_inside_out_is_turned() {
    let mesh = box_mesh();
    let mut inside_out = mesh.clone();
    inside_out.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let turned = read_mesh("box.stl", &binary_stl(&inside_out)).unwrap();
    assert_eq!(corners(&turned), corners(&mesh));
}

#[test]
fn a_polygon_that_is_not_convex_keeps_its_area() {
    // A prism of height 1 over an arrow head of area 1 whose first corner sees not all of it.
    let text = "v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\nv 0 0 1\nv 2 -1 1\nv 1 0 1\nv 2 1 1\n\
        f 2 1 4 3\nf 6 7 8 5\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let mesh = read_mesh("arrow.obj", text.as_bytes()).unwrap();
    assert_eq!(mesh.flaw(), None);
    assert!((mesh.volume() - 1.0).abs() < 1e-15);
    assert!((mesh.properties(1.0).centre[0] - 1.0).abs() < 1e-15);
}

#[test]
fn what_is_no_mesh_is_told() {
    assert_eq!(told("part.step", "solid"), "`part.step` ends in neither .stl nor .obj, and other meshes are not read");
    assert_eq!(told("stl", "solid"), "`stl` ends in neither .stl nor .obj, and other meshes are not read");
    assert_eq!(told("a.stl", ""), "the file is empty");
    assert_eq!(told("a.obj", " \r\n"), "the file is empty");
    assert_eq!(told("a.obj", vec![b' '; LARGEST_MESH + 1]), "the file has 20971521 bytes, and at most 20 MB are read");
    let no_stl = "the file is no mesh: it neither begins with `solid` nor has the length that a binary STL file announces";
    assert_eq!(told("a.stl", "v 0 0 0"), no_stl);
    assert_eq!(told("a.stl", "Dear reader, this is a letter and no mesh. ".repeat(9)), no_stl);
    assert_eq!(told("a.stl", [0; 90]), no_stl);
    assert_eq!(told("a.stl", [0; 84]), "the file is no mesh: it has no triangles");
    assert_eq!(told("a.stl", "solid a\nendsolid a"), "the file is no mesh: it has no facets");
    assert_eq!(told("a.obj", [0xff; 90]), "the file is no mesh: it has no vertices (lines with `v`)");
    assert_eq!(told("a.obj", "v 0 0 0\nl 1 1\n"), "the file is no mesh: it has no faces (lines with `f`)");
}

#[test]
fn a_header_that_lies_and_a_file_that_ends_early_are_told() {
    let whole = binary_stl(&box_mesh());
    let prefix = "the file is truncated, or no STL file: as a binary one it announces";
    assert_eq!(told("a.stl", &whole[..whole.len() - 1]), format!("{prefix} 12 triangles and has 11"));
    let mut lying = whole.clone();
    lying[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(told("a.stl", &lying), format!("{prefix} 4294967295 triangles and has 12"));
    lying[..6].copy_from_slice(b"solid ");
    assert_eq!(told("a.stl", &lying), format!("{prefix} 4294967295 triangles and has 12"));

    let text = ascii_stl(&box_mesh());
    let cut = |at: &str, keep: usize| told("a.stl", &text[..text.find(at).unwrap() + keep]);
    assert_eq!(cut("outer loop", 10), "the file is truncated: it ends within the loop of a facet");
    assert_eq!(cut("endloop", 7), "the file is truncated: it ends within a facet");
    assert_eq!(cut("endfacet", 8), "the file is truncated: it ends within a solid: `endsolid` is missing");
}

#[test]
fn what_is_wrong_on_a_line_is_told_with_its_number() {
    let text = ascii_stl(&box_mesh());
    let with = |from: &str, to: &str| told("a.stl", text.replacen(from, to, 1));
    assert_eq!(with("vertex 0e0 2e0", "vertex 0,5 2e0"), "line 4: `0,5` stands where a coordinate is expected");
    assert_eq!(with("vertex 0e0 2e0", "vertex nan 2e0"), "line 4: `nan` stands where a coordinate is expected");
    assert_eq!(with("vertex 0e0 2e0 0e0", "vertex 0 2"), "line 4: `nothing` stands where a coordinate is expected");
    assert_eq!(with("    endloop\n", ""), "line 7: `endfacet` stands where `vertex` or, after three of them, `endloop` is expected");
    assert_eq!(with("    outer loop\n", "\u{1b}[31m\n"), "line 3: `\\u{1b}[31m` stands where `outer loop` or `endfacet` is expected");
    assert_eq!(told("a.obj", "v 0 0"), "line 1: `nothing` stands where a coordinate is expected");
    assert_eq!(told("a.obj", "v 0 0 1e60"), "line 1: `1e60` stands where a coordinate is expected");
    assert_eq!(told("a.obj", "v 0 0 0\nf 1 1"), "line 2: `a face of 2 vertices` stands where a face of three or more is expected");
    assert_eq!(told("a.obj", "v 0 0 0\nf 1 x 1"), "line 2: `x` stands where the number of a vertex is expected");
    for vertex in ["0", "2", "-2", "9223372036854775807", "-9223372036854775808"] {
        let expected = format!("line 2: the face names vertex {vertex}, and 1 vertices are above it");
        assert_eq!(told("a.obj", format!("v 0 0 0\nf 1 1 {vertex}/-9/-9")), expected);
    }
    let mut bytes = binary_stl(&box_mesh());
    bytes[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(told("a.stl", bytes), "triangle 2 has a coordinate that is no number below 1e50 m");
}

#[test]
fn polygons_cannot_make_a_file_grow_without_end() {
    let text = format!("v 0 0 0\nf {}", "1 ".repeat(MOST_TRIANGLES + 10));
    assert_eq!(told("a.obj", text), "the mesh has more than 1000000 triangles");
}

#[test]
fn damaged_files_are_refused_or_read_and_never_panic() {
    let mesh = box_mesh();
    // A linear congruence (Knuth: MMIX) spreads the damage.
    let mut seed = 1_u64;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    let files = [("a.stl", binary_stl(&mesh)), ("a.stl", ascii_stl(&mesh).into_bytes()), ("a.obj", BOX_OBJ.as_bytes().to_vec())];
    let (mut read, mut refused) = (0, 0);
    for (name, whole) in files {
        for _ in 0..2000 {
            let mut bytes = whole.clone();
            for _ in 0..=random(4) {
                let at = random(bytes.len());
                bytes[at] = random(256) as u8;
            }
            if random(3) == 0 {
                bytes.truncate(random(whole.len()));
            }
            match read_mesh(name, &bytes) {
                Ok(mesh) => {
                    read += 1;
                    if mesh.flaw().is_none() {
                        assert!(mesh.volume() > 0.0);
                    }
                }
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().is_empty());
                }
            }
        }
    }
    assert!(read > 500 && refused > 500, "{read} and {refused}");
}
