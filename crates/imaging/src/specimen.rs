//! Drawing plates whose truth is known.
