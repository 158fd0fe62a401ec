//! Textures: images, samplers and transforms of texture coordinates.

use super::importer::Importer;
use super::uri::Resolved;
use crate::decode::Channel;
use crate::error::SceneError;
use crate::plan::{ImageSource, TexturePlan, TextureSource};
use base::file_kind::file_kind;
use glam::{Mat3, Vec2, Vec3};
use gltf_json::extensions::texture::TextureTransform;
use gltf_json::material::NormalTexture;
use gltf_json::texture::{Info, MagFilter, Sampler, Texture, WrappingMode};
use gltf_json::validation::Checked;
use gltf_json::{Index, image};
use scene::{Filter, TextureId, Wrap};

/// Types that a file states, and the kinds of the images.
const MIME_TYPES: [(&str, &str); 4] = [
    ("image/png", "a PNG image"),
    ("image/jpeg", "a JPEG image"),
    ("image/jpg", "a JPEG image"),
    ("image/webp", "a WebP image"),
];

/// Reference of a material to a texture.
#[derive(Clone, Debug)]
pub(super) struct TextureUse {
    texture: Index<Texture>,
    /// Index of the set of texture coordinates.
    pub set: u32,
    transform: Option<TextureTransform>,
}

impl TextureUse {
    pub fn read(info: &Info) -> TextureUse {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.clone());
        TextureUse::new(info.index, info.tex_coord, transform)
    }

    pub fn of_normal(info: &NormalTexture) -> TextureUse {
        let raw = info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform"));
        let transform = raw.and_then(|raw| serde_json::from_value(raw.clone()).ok());
        TextureUse::new(info.index, info.tex_coord, transform)
    }

    fn new(texture: Index<Texture>, set: u32, transform: Option<TextureTransform>) -> TextureUse {
        let set = transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(set);
        TextureUse { texture, set, transform }
    }

    /// Returns the transform of texture coordinates in the convention of the renderer, v upwards. glTF counts v
    /// downwards.
    fn to_uv(&self) -> Mat3 {
        let Some(transform) = &self.transform else { return Mat3::IDENTITY };
        let (sin, cos) = transform.rotation.0.sin_cos();
        let turn = Mat3::from_cols(Vec3::new(cos, -sin, 0.0), Vec3::new(sin, cos, 0.0), Vec3::Z);
        let scale = Mat3::from_scale(Vec2::from(transform.scale.0));
        let flip = Mat3::from_cols(Vec3::X, Vec3::NEG_Y, Vec3::new(0.0, 1.0, 1.0));
        flip * Mat3::from_translation(Vec2::from(transform.offset.0)) * turn * scale * flip
    }
}

/// Returns the image of a texture: PNG or JPEG if there is one, else WebP.
fn image_of(texture: &Texture) -> Option<Index<image::Image>> {
    if texture.source.value() != u32::MAX as usize {
        return Some(texture.source);
    }
    let webp = texture.extensions.as_ref()?.others.get("EXT_texture_webp")?;
    Some(Index::new(u32::try_from(webp.get("source")?.as_u64()?).ok()?))
}

impl Importer<'_> {
    /// Returns the texture of the material `name`; `None` if it cannot be read, which a warning says.
    pub(super) fn texture(&mut self, slot: &TextureUse, channel: Channel, name: &str) -> Option<TextureId> {
        self.found_texture(slot, channel, name).unwrap_or_else(|error| {
            let what = match error {
                SceneError::Mesh { what, .. } => what,
                other => other.to_string(),
            };
            let fallback = "the texture is left out; export it again";
            self.report.lacks(&format!("a texture cannot be read: {what}"), fallback, name);
            None
        })
    }

    fn found_texture(
        &mut self,
        slot: &TextureUse,
        channel: Channel,
        name: &str,
    ) -> Result<Option<TextureId>, SceneError> {
        let texture = self.document.get(slot.texture, "texture")?;
        let Some(index) = image_of(texture) else {
            let what = "textures of other kinds than PNG, JPEG and WebP are not supported";
            self.report.lacks(what, "they are left out; export them as one of these", name);
            return Ok(None);
        };
        let image = self.document.get(index, "image")?;
        let default = Sampler::default();
        let sampler = match texture.sampler {
            Some(index) => self.document.get(index, "sampler")?,
            None => &default,
        };
        let [wrap, wrap_v] = [&sampler.wrap_s, &sampler.wrap_t].map(|mode| match mode {
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
        });
        if wrap != wrap_v {
            self.report.lacks("textures with different wrap modes along u and v", "v is as u", name);
        }
        if [&sampler.wrap_s, &sampler.wrap_t].into_iter().any(|mode| matches!(mode, Checked::Invalid)) {
            self.report.lacks("a wrap mode that glTF does not define", "the texture repeats", name);
        }
        if matches!(sampler.mag_filter, Some(Checked::Invalid)) {
            self.report.lacks("a magFilter that glTF does not define", "texels are interpolated", name);
        }
        let filter = match sampler.mag_filter {
            Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
            _ => Filter::Bilinear,
        };
        // Interpolated values are cut afterwards.
        let (channel, filter) = match (channel, filter) {
            (Channel::AlphaFrom(cutoff), Filter::Bilinear) => (Channel::One(3), Filter::Cut(cutoff)),
            other => other,
        };
        let image_name = image.name.clone().unwrap_or_else(|| format!("image {}", index.value()));
        let source = self.image(image, index)?;
        if let (ImageSource::Bytes(bytes), Some(stated)) = (&source, &image.mime_type)
            && let Some(kind) = file_kind(bytes).filter(|kind| kind.is_read_as(""))
            && !MIME_TYPES.contains(&(stated.0.as_str(), kind.what))
        {
            let what = format!("an image is stated to be {}, and its bytes are {}", stated.0, kind.what);
            self.report.note(&what, "the bytes count", &image_name);
        }
        let image = TextureSource::Part { name: image_name, source, channel };
        let to_uv = slot.to_uv();
        if !to_uv.is_finite() {
            return Err(self.document.wrong(format!("a texture transform of {name} is not finite")));
        }
        let place = self.document.place.clone();
        Ok(Some(self.contents.add_texture(TexturePlan { place, image, filter, wrap, to_uv })))
    }

    fn image(&mut self, image: &image::Image, index: Index<image::Image>) -> Result<ImageSource, SceneError> {
        if let Some(source) = self.images.get(&index.value()) {
            return Ok(source.clone());
        }
        let source = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => match self.document.resolve(uri)? {
                Resolved::Bytes(bytes) => ImageSource::Bytes(bytes.into()),
                Resolved::File(path) => ImageSource::File(path),
            },
            (None, Some(view)) => ImageSource::Bytes(self.document.view(view)?.into()),
            (None, None) => {
                return Err(self
                    .document
                    .wrong(format!("image {} has neither a URI nor a buffer view", index.value())));
            }
        };
        self.images.insert(index.value(), source.clone());
        Ok(source)
    }
}
