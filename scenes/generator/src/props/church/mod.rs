//! Furnishings of a church.

mod candles;
mod furnishings;

pub use candles::{candle_crown, candlestick};
pub use furnishings::{altar, font, pew, pulpit};
