//! One connection of a client: reads a request, answers it and hangs up.

use std::{pin::Pin, time::Duration};

use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _},
    time::timeout,
};

use super::{
    Scrapes,
    http::{self, MAX_REQUEST, Refusal},
};

/// Timeout of a whole request.
const REQUEST: Duration = Duration::from_secs(2);
/// Timeout of writing the response.
const RESPONSE: Duration = Duration::from_secs(5);
/// Timeout of the client's end of the connection.
const FAREWELL: Duration = Duration::from_secs(1);

/// Answers one request. The timeouts bound the time and [`MAX_REQUEST`] the memory.
pub(super) async fn answer(stream: impl AsyncRead + AsyncWrite, scrapes: &Scrapes) {
    let (reader, writer) = tokio::io::split(stream);
    tokio::pin!(reader, writer);
    let response = match timeout(REQUEST, request(reader.as_mut())).await {
        Ok(Some(Ok(request))) => match scrapes.text() {
            Some(text) => request.response(&text),
            None => Refusal::Broken.response(),
        },
        Ok(Some(Err(refusal))) => refusal.response(),
        // The client hung up.
        Ok(None) => return,
        Err(_) => Refusal::Late.response(),
    };
    let written = timeout(RESPONSE, async {
        writer.write_all(&response).await?;
        writer.shutdown().await
    });
    if let Ok(Ok(())) = written.await {
        let _ = timeout(FAREWELL, read_to_end(reader)).await;
    }
}

/// Reads until a request is complete or refused; `None` if the client hangs up before.
async fn request(mut reader: Pin<&mut impl AsyncRead>) -> Option<Result<http::Request, Refusal>> {
    let mut bytes = Vec::new();
    loop {
        let mut buffer = [0; 1024];
        let room = (MAX_REQUEST - bytes.len()).min(buffer.len());
        let count = reader.read(buffer.get_mut(..room)?).await.ok().filter(|count| *count > 0)?;
        bytes.extend_from_slice(buffer.get(..count)?);
        if let Some(request) = http::parse(&bytes) {
            return Some(request);
        }
    }
}

/// Discards the rest of a request. Unread bytes would make the system reset the connection, and the
/// client would lose the response.
async fn read_to_end(mut reader: Pin<&mut impl AsyncRead>) {
    let mut buffer = [0; 1024];
    while reader.read(&mut buffer).await.is_ok_and(|count| count > 0) {}
}
