//! `holonom view`.

use std::process::ExitCode;

use tiny_http::{Header, Response, Server};

use crate::failure::Failure;
use crate::message::note;
use crate::options::ViewArguments;

/// Serves the report of a folder on this machine only, until it is interrupted.
pub fn view(arguments: &ViewArguments) -> Result<ExitCode, Failure> {
    let path = arguments.folder.join("report.html");
    let page =
        std::fs::read(&path).map_err(|source| Failure::unread(path, source, "name a folder that a command left without --no-report"))?;
    let server = Server::http(("127.0.0.1", arguments.port)).map_err(|error| {
        Failure::usage(format!("cannot serve on port {}: {error}", arguments.port), "take another port, or 0 for a free one")
    })?;
    let address = format!("http://{}", server.server_addr());
    println!("{address}");
    if !arguments.no_browser
        && let Err(error) = open::that_detached(&address)
    {
        note(&format!("no browser could be opened ({error}): open the address yourself"));
    }
    let html = Header::from_bytes("Content-Type", "text/html; charset=utf-8").expect("the header is valid");
    for request in server.incoming_requests() {
        let response = match request.url() {
            "/" | "/report.html" => {
                // With its length and not in chunks: what is sent is the file, byte for byte.
                request.respond(Response::from_data(page.clone()).with_header(html.clone()).with_chunked_threshold(usize::MAX))
            }
            _ => request.respond(Response::from_string("not here").with_status_code(404)),
        };
        // A browser that went away is none of our business.
        let _ = response;
    }
    Ok(ExitCode::SUCCESS)
}
