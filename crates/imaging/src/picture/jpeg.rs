//! Whether a JPEG file is there to its end: decoders fill up what is missing with grey and say nothing.

use std::io::{BufRead, Read, Result, copy, sink};

/// First byte of every marker.
const LEAD: u8 = 0xff;

/// Whether the end-of-image marker is there, from the start of the file (ITU T.81, annex B). The segments are walked, so
/// that neither the end of a thumbnail inside the file nor bytes after the end mislead.
pub(crate) fn has_end(mut jpeg: impl BufRead) -> Result<bool> {
    while jpeg.skip_until(LEAD)? > 0 {
        let mut marker = LEAD;
        // Any number of fill bytes may stand before a marker.
        while marker == LEAD {
            let Some(byte) = next_byte(&mut jpeg)? else { return Ok(false) };
            marker = byte;
        }
        match marker {
            0xd9 => return Ok(true),
            // A byte 0xff of the coded picture, and markers without a segment: start of image, TEM, restart.
            0x00 | 0x01 | 0xd0..=0xd8 => {}
            _ => {
                let (Some(high), Some(low)) = (next_byte(&mut jpeg)?, next_byte(&mut jpeg)?) else {
                    return Ok(false);
                };
                // The length counts its own two bytes.
                let rest = u64::from(u16::from_be_bytes([high, low])).saturating_sub(2);
                copy(&mut jpeg.by_ref().take(rest), &mut sink())?;
            }
        }
    }
    Ok(false)
}

fn next_byte(jpeg: &mut impl BufRead) -> Result<Option<u8>> {
    let byte = jpeg.fill_buf()?.first().copied();
    jpeg.consume(usize::from(byte.is_some()));
    Ok(byte)
}
