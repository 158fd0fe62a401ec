//! Changes of files: of bits, numbers, words and runs of bytes.

use std::ops::Range;

/// Numbers that readers meet seldom.
const NUMBERS: [&str; 24] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "255",
    "256",
    "65535",
    "65536",
    "1048577",
    "2147483647",
    "-2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "99999999999999999999999",
    "1e-40",
    "1e-20",
    "1e10",
    "1e19",
    "-1e30",
    "1e39",
    "nan",
    "inf",
];

/// Random numbers: xorshift64* (Vigna, *An experimental exploration of Marsaglia's xorshift generators*, 2016).
pub struct Random(u64);

impl Random {
    /// Numbers that follow from `seed`.
    pub fn new(seed: u64) -> Random {
        // Steps of the golden ratio tell neighbouring seeds apart.
        Random((seed.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1).rotate_left(17))
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// A number from 0 to below `count`; 0 if that is 0.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.next()) * count as u128) >> 64) as usize
    }

    /// One of several.
    pub fn pick<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        &of[self.below(of.len())]
    }
}

/// Changes `bytes`: mostly one number, so that many files load yet; else one to four places of any kind, with runs
/// of `other`.
pub fn mutate(bytes: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut changed = bytes.to_vec();
    let is_text = std::str::from_utf8(bytes).is_ok();
    if random.below(5) > 0 {
        if is_text {
            change_number(&mut changed, random);
        } else if !bytes.is_empty() {
            changed[random.below(bytes.len())] ^= 1 << random.below(8);
        }
        return changed;
    }
    for _ in 0..=random.below(8) / 2 {
        if is_text && random.below(4) > 0 {
            change_text(&mut changed, other, random);
        } else {
            change_bytes(&mut changed, other, random);
        }
    }
    changed
}

fn change_bytes(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.below(bytes.len());
    match random.below(8) {
        0 => bytes.truncate(at),
        1 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        2 if at < bytes.len() => bytes[at] = random.below(256) as u8,
        3 | 4 => {
            let value: u64 =
                *random.pick(&[0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFF_FFFF, 0xFFFF_FFFF, u64::MAX]);
            let float = *random.pick(&[f32::NAN, f32::INFINITY, -1.0, 1e-40, 1e38]);
            let mut number = match random.below(3) {
                0 => float.to_le_bytes().to_vec(),
                1 => value.to_le_bytes()[..*random.pick(&[2, 4, 8])].to_vec(),
                _ => value.to_be_bytes()[*random.pick(&[0, 4, 6])..].to_vec(),
            };
            number.truncate(bytes.len() - at);
            bytes[at..at + number.len()].copy_from_slice(&number);
        }
        5 => {
            let run = at..(at + 1 + random.below(64)).min(bytes.len());
            bytes.drain(run);
        }
        6 => {
            let run: Vec<u8> = bytes[at..].iter().take(1 + random.below(64)).copied().collect();
            let to = random.below(bytes.len());
            bytes.splice(to..to, run.repeat(1 + random.below(8)));
        }
        _ => {
            let from = random.below(other.len());
            let run: Vec<u8> = other[from..].iter().take(1 + random.below(256)).copied().collect();
            bytes.splice(at..at, run);
        }
    }
}

/// Places of the numbers of a text.
pub fn number_places(bytes: &[u8]) -> Vec<Range<usize>> {
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b"_.+-#".contains(&b);
    let is_number = |run: &Range<usize>| {
        std::str::from_utf8(&bytes[run.clone()])
            .is_ok_and(|text| text.parse::<f64>().is_ok_and(f64::is_finite))
    };
    runs(bytes, is_word).into_iter().filter(is_number).collect()
}

/// Changes a number of a text to one of its kind.
fn change_number(bytes: &mut Vec<u8>, random: &mut Random) {
    let numbers = number_places(bytes);
    if numbers.is_empty() {
        return;
    }
    let place = random.pick(&numbers).clone();
    let own = String::from_utf8_lossy(&bytes[place.clone()]).into_owned();
    let new = match random.below(8) {
        0 | 1 => {
            // Another digit.
            let digits: Vec<usize> =
                own.bytes().enumerate().filter(|(_, b)| b.is_ascii_digit()).map(|d| d.0).collect();
            let at = *random.pick(&digits);
            format!("{}{}{}", &own[..at], random.below(10), &own[at + 1..])
        }
        2 => own.strip_prefix('-').map_or_else(|| format!("-{own}"), str::to_owned),
        3 | 4 if !own.contains(['e', 'E']) => format!("{own}e{}", random.below(31) as i32 - 15),
        3..=6 => String::from_utf8_lossy(&bytes[random.pick(&numbers).clone()]).into_owned(),
        _ => (*random.pick(&NUMBERS)).to_owned(),
    };
    bytes.splice(place, new.into_bytes());
}

fn change_text(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let is_number = |b: u8| b.is_ascii_digit() || b == b'.' || b == b'-';
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
    match random.below(6) {
        0..=2 => {
            let numbers = runs(bytes, is_number);
            if !numbers.is_empty() {
                let place = random.pick(&numbers).clone();
                bytes.splice(place, random.pick(&NUMBERS).bytes());
            }
        }
        3 => {
            let (words, others) = (runs(bytes, is_word), runs(other, is_word));
            if !words.is_empty() && !others.is_empty() {
                let (place, from) = (random.pick(&words).clone(), random.pick(&others).clone());
                bytes.splice(place, other[from].to_vec());
            }
        }
        4 => {
            let words = runs(bytes, is_word);
            if !words.is_empty() {
                let (place, from) = (random.pick(&words).clone(), random.pick(&words).clone());
                let word = bytes[from].to_vec();
                bytes.splice(place, word);
            }
        }
        _ => {
            // A line goes, or stands several times.
            let lines = runs(bytes, |b| b != b'\n');
            if !lines.is_empty() {
                let place = random.pick(&lines).clone();
                let line = [&bytes[place.clone()], b"\n"].concat();
                bytes.splice(place, line.repeat(*random.pick(&[0, 2, 3, 50])));
            }
        }
    }
}

/// Longest runs of bytes of a kind.
fn runs(bytes: &[u8], is_in: impl Fn(u8) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for at in (0..bytes.len()).filter(|&at| is_in(bytes[at])) {
        match runs.last_mut() {
            Some(run) if run.end == at => run.end = at + 1,
            _ => runs.push(at..at + 1),
        }
    }
    runs
}
