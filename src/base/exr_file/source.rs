//! Opening of OpenEXR files, and reading of channels.

use super::channels::PartNames;
use super::error::ExrError;
use super::subsampled;
use ::exr::block::UncompressedBlock;
use ::exr::block::chunk::Chunk;
use ::exr::io::PeekRead;
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{ChannelDescription, IntegerBounds, SampleType};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::prelude::{FlatSamples, Text, Vec2, f16};
use rayon::prelude::*;
use std::io::{Read, Seek, SeekFrom};

/// Number of blocks that are decompressed at once.
const BATCH: usize = 64;

/// Reason for refusing deep data.
const DEEP: &str = "the file holds deep data, which is not supported; flatten the image";

/// An open OpenEXR file. Its headers are read and checked.
#[derive(Debug)]
pub struct ExrSource<R> {
    reader: R,
    meta: MetaData,
    /// Positions of the blocks of each part.
    blocks: Vec<Vec<u64>>,
}

impl<R: Read + Seek> ExrSource<R> {
    /// Reads the headers. No memory is allocated for pixels.
    ///
    /// # Errors
    /// If the headers are damaged.
    pub fn open(mut reader: R) -> Result<ExrSource<R>, ExrError> {
        let meta = MetaData::read_from_buffered(&mut reader, false)?;
        check(&meta.headers)?;
        let blocks = MetaData::read_offset_tables(&mut PeekRead::new(&mut reader), &meta.headers)?;
        Ok(ExrSource { reader, meta, blocks: blocks.into_vec() })
    }

    /// Returns the headers of the parts.
    pub fn headers(&self) -> &[Header] {
        &self.meta.headers
    }

    /// Returns the names of the parts and their channels.
    pub fn names(&self) -> Vec<PartNames> {
        let names = |header: &Header| PartNames {
            name: header.own_attributes.layer_name.as_ref().map(text).unwrap_or_default(),
            channels: header.channels.list.iter().map(|channel| text(&channel.name)).collect(),
            is_deep: header.deep,
            views: views(&header.own_attributes),
        };
        self.headers().iter().map(names).collect()
    }

    /// Reads channels of a flat part at the largest level. Subsampled channels are interpolated to its full size.
    ///
    /// The caller checks first that the size of the part is plausible and fits into memory.
    ///
    /// # Errors
    /// If the part is deep, or its blocks are damaged.
    pub fn read(&mut self, part: usize, channels: &[usize]) -> Result<Vec<FlatSamples>, ExrError> {
        let header = &self.meta.headers[part];
        if header.deep {
            return Err(ExrError::content(DEEP));
        }
        let list = &header.channels.list;
        let mut planes: Vec<Plane> =
            channels.iter().map(|&c| Plane::new(&list[c], header.layer_size)).collect();
        let mut positions = std::mem::take(&mut self.blocks[part]);
        positions.sort_unstable();
        let read = positions.chunks(BATCH).try_for_each(|batch| -> Result<(), ExrError> {
            let blocks: Vec<Chunk> =
                batch.iter().map(|position| self.block(part, *position)).collect::<Result<_, _>>()?;
            let header = &self.meta.headers[part];
            let decompress = |block| decompress(&self.meta, part, block);
            let blocks: Vec<Option<Block>> =
                blocks.into_par_iter().map(decompress).collect::<Result<_, ExrError>>()?;
            for block in blocks.iter().flatten() {
                block.each_row(header, |channel, [x, y], bytes| {
                    let wanted = channels.iter().zip(&mut planes).filter(|(own, _)| **own == channel);
                    wanted.for_each(|(_, plane)| plane.put([x, y], bytes));
                });
            }
            Ok(())
        });
        self.blocks[part] = positions;
        read?;
        let header = &self.meta.headers[part];
        let enlarged = |(&channel, plane): (&usize, Plane)| {
            let Vec2(across, down) = header.channels.list[channel].sampling;
            subsampled::enlarge(plane.samples, plane.size, [across, down])
        };
        Ok(channels.iter().zip(planes).map(enlarged).collect())
    }

    /// Reads the block at a position of the file.
    fn block(&mut self, part: usize, position: u64) -> Result<Chunk, ExrError> {
        if self.reader.stream_position().map_err(ExrError::Io)? != position {
            self.reader.seek(SeekFrom::Start(position)).map_err(ExrError::Io)?;
        }
        let block = Chunk::read(&mut self.reader, &self.meta)?;
        if block.layer_index == part {
            Ok(block)
        } else {
            Err(ExrError::content("a block belongs to another part"))
        }
    }
}

/// Returns a name of the file as text.
pub(super) fn text(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

/// Returns the names of the views of a part, the default view first.
pub fn views(attributes: &LayerAttributes) -> Vec<String> {
    let listed = attributes.multi_view_names.iter().flatten();
    attributes.view_name.iter().chain(listed).map(text).collect()
}

/// Checks the headers. The library does so too, but rejects deep parts and subsampled channels.
fn check(headers: &[Header]) -> Result<(), ExrError> {
    let mut plain: Vec<Header> = headers.iter().filter(|header| !header.deep).cloned().collect();
    for header in &mut plain {
        let Vec2(left, top) = header.own_attributes.layer_position;
        let Vec2(width, height) = header.layer_size;
        for ChannelDescription { name, sampling, .. } in &mut header.channels.list {
            let Vec2(across, down) = *sampling;
            let divides = |step: usize, start: i32, size: usize| {
                step > 0 && size.is_multiple_of(step) && i64::from(start).rem_euclid(step as i64) == 0
            };
            if !(divides(across, left, width) && divides(down, top, height)) {
                let what = "the data window is not a multiple of the sampling";
                return Err(ExrError::Content(format!("channel {}: {what}", text(name))));
            }
            *sampling = Vec2(1, 1);
        }
    }
    if plain.is_empty() {
        return Err(ExrError::content(DEEP));
    }
    MetaData::validate(&plain, false)?;
    Ok(())
}

/// A decompressed block.
struct Block {
    section: IntegerBounds,
    /// Rows from top to bottom. A row has the samples of each channel that is sampled there.
    data: Vec<u8>,
}

/// Decompresses a block; `None` if it belongs to a smaller level.
fn decompress(meta: &MetaData, part: usize, block: Chunk) -> Result<Option<Block>, ExrError> {
    let header = &meta.headers[part];
    let at = header.get_block_data_indices(&block.compressed_block)?;
    if at.level_index != Vec2(0, 0) {
        return Ok(None);
    }
    let section = header.get_absolute_block_pixel_coordinates(at)?;
    section.validate(Some(header.layer_size))?;
    let is_whole = header.channels.list.iter().all(|channel| channel.sampling == Vec2(1, 1));
    let data = match is_whole {
        true => UncompressedBlock::decompress_chunk(block, meta, false)?.data,
        false => subsampled::decompress(header, block, section)?,
    };
    Ok(Some(Block { section, data }))
}

impl Block {
    /// Passes on the rows of all channels: channel, position of the first sample, and bytes.
    fn each_row(&self, header: &Header, mut row: impl FnMut(usize, [usize; 2], &[u8])) {
        let mut rest = self.data.as_slice();
        let (Vec2(left, top), Vec2(width, height)) = (self.section.position, self.section.size);
        let (left, top) = (left.max(0) as usize, top.max(0) as usize);
        for y in top..top + height {
            for (index, channel) in header.channels.list.iter().enumerate() {
                let Vec2(across, down) = channel.sampling;
                if !y.is_multiple_of(down) {
                    continue;
                }
                let length = width / across * channel.sample_type.bytes_per_sample();
                let (own, others) = rest.split_at(length.min(rest.len()));
                row(index, [left / across, y / down], own);
                rest = others;
            }
        }
    }
}

/// Samples of a channel.
struct Plane {
    size: [usize; 2],
    samples: FlatSamples,
}

impl Plane {
    fn new(channel: &ChannelDescription, image: Vec2<usize>) -> Plane {
        let size = [image.0 / channel.sampling.0, image.1 / channel.sampling.1];
        let count = size[0] * size[1];
        let samples = match channel.sample_type {
            SampleType::F16 => FlatSamples::F16(vec![f16::ZERO; count]),
            SampleType::F32 => FlatSamples::F32(vec![0.0; count]),
            SampleType::U32 => FlatSamples::U32(vec![0; count]),
        };
        Plane { size, samples }
    }

    /// Stores samples from a position to the right.
    fn put(&mut self, [x, y]: [usize; 2], bytes: &[u8]) {
        fn copy<const N: usize, T>(to: &mut [T], from: &[u8], number: fn([u8; N]) -> T) {
            to.iter_mut().zip(from.as_chunks().0).for_each(|(to, from)| *to = number(*from));
        }
        let at = y * self.size[0] + x;
        match &mut self.samples {
            FlatSamples::F16(samples) => copy(&mut samples[at..], bytes, f16::from_ne_bytes),
            FlatSamples::F32(samples) => copy(&mut samples[at..], bytes, f32::from_ne_bytes),
            FlatSamples::U32(samples) => copy(&mut samples[at..], bytes, u32::from_ne_bytes),
        }
    }
}
