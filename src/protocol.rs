//! Pure codecs of the controllers: typed requests and replies, bytes in and out.

pub mod satrak;
