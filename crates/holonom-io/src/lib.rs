//! The outside of the engine: model files in, tables out.

mod json;
mod read;
mod write;

pub use json::to_json;
pub use read::{
    DEEPEST, LARGEST_FILE, LARGEST_MESH, LARGEST_NUMBERS, MOST_TRIANGLES, MeshError, Source, TableError, read_csv, read_mesh,
    read_recording, read_value, sha256,
};
pub use write::{
    Cells, Table, WRITERS, WriteTable, Writer, append_csv, append_csv_text, csv_cells, csv_line, csv_number, headings, model_text,
    write_json,
};
