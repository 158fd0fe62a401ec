//! Kinds of files by their first bytes, for messages about a file that is something else than its name says; and texts
//! in UTF-16.

/// Bytes at the start of a file in which words of a text are looked for.
const HEAD: usize = 1024;

/// Extensions of scenes, meshes and texts, which are no images.
const NO_IMAGES: [&str; 10] =
    ["glb", "gltf", "obj", "mtl", "ply", "stl", "serialized", "toml", "xml", "json"];

/// Remedy for files that came from the network as something else.
const AGAIN: &str = "download the file again; the server sent a page about it instead";
const FROM_BLENDER: &str = "import it in Blender, then export glTF 2.0 (.glb)";
const TO_PNG: &str = "convert it to PNG";
const AS_TEXT: &str = "save it as plain text in UTF-8";
const AN_IMAGE: &str = "name it where an image is expected, or name another file";

/// Files that are read under some extensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Readers {
    Nobody,
    /// Readers of images, whatever the extension.
    Images,
    /// Readers of files with one of these extensions.
    Extensions(&'static [&'static str]),
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileKind {
    /// Name with its article.
    pub what: &'static str,
    /// Remedy.
    pub remedy: &'static str,
    readers: Readers,
}

impl FileKind {
    /// Returns true if files of the kind are read under an extension, which is in lower case.
    pub fn is_read_as(&self, extension: &str) -> bool {
        match self.readers {
            Readers::Nobody => false,
            Readers::Images => !NO_IMAGES.contains(&extension),
            Readers::Extensions(extensions) => extensions.contains(&extension),
        }
    }

    /// Returns true if the file is in place of another one, about which its extension is right.
    pub fn is_substitute(&self) -> bool {
        [EMPTY, POINTER, PAGE].contains(self)
    }
}

const fn kind(what: &'static str, remedy: &'static str) -> FileKind {
    FileKind { what, remedy, readers: Readers::Nobody }
}

const fn image(what: &'static str) -> FileKind {
    FileKind { what, remedy: AN_IMAGE, readers: Readers::Images }
}

const EMPTY: FileKind = kind("an empty file", "download or export it again");
const POINTER: FileKind = kind("a pointer of Git LFS", "run `git lfs pull` to get the file itself");
const PAGE: FileKind = kind("an HTML page", AGAIN);

const OFF: FileKind = kind("a mesh in the format OFF", "convert it to PLY or OBJ");
const TIFF: FileKind = kind("a TIFF image", "convert it to PNG or OpenEXR");
const GLB: FileKind = FileKind {
    readers: Readers::Extensions(&["glb", "gltf"]),
    ..kind("a binary glTF model", "give it a name that ends in .glb")
};
const PLY: FileKind = FileKind {
    readers: Readers::Extensions(&["ply"]),
    ..kind("a PLY mesh", "give it a name that ends in .ply")
};

/// Kinds with their first bytes.
const STARTS: [(&[u8], FileKind); 42] = [
    (b"version https://git-lfs.github.com/spec/", POINTER),
    (b"PK\x03\x04", kind("a zip archive", "unpack it with unzip, and name a file in it")),
    (b"PK\x05\x06", kind("an empty zip archive", "pack it again")),
    (b"\x1F\x8B\x08", kind("a file compressed with gzip", "decompress it with gunzip")),
    (b"7z\xBC\xAF\x27\x1C", kind("a 7z archive", "unpack it with 7z, and name a file in it")),
    (b"Rar!\x1A\x07", kind("a rar archive", "unpack it with unrar, and name a file in it")),
    (b"\xFD7zXZ\0", kind("a file compressed with xz", "decompress it with unxz")),
    (b"BZh", kind("a file compressed with bzip2", "decompress it with bunzip2")),
    (b"\x28\xB5\x2F\xFD", kind("a file compressed with zstd", "decompress it with unzstd")),
    (b"\x04\x22\x4D\x18", kind("a file compressed with lz4", "decompress it with unlz4")),
    (b"%PDF-", kind("a PDF document", "export the model itself as glTF 2.0 (.glb)")),
    (b"{\\rtf", kind("a text with formats (RTF)", AS_TEXT)),
    (b"\xFF\xFE\0\0", kind("a text in UTF-32", AS_TEXT)),
    (b"\0\0\xFE\xFF", kind("a text in UTF-32", AS_TEXT)),
    (b"BLENDER", kind("a file of Blender", "export glTF 2.0 (.glb) from Blender")),
    (b"Kaydara FBX Binary", kind("an FBX model", FROM_BLENDER)),
    (b"; FBX ", kind("an FBX model", FROM_BLENDER)),
    (b"#usda ", kind("a USD scene", FROM_BLENDER)),
    (b"PXR-USDC", kind("a USD scene", FROM_BLENDER)),
    (b"Ogawa", kind("an Alembic scene", FROM_BLENDER)),
    (b"#VRML", kind("a VRML scene", FROM_BLENDER)),
    (b"OFF\n", OFF),
    (b"OFF\r", OFF),
    (b"3D Geometry File Format", kind("a model of Rhino", "export glTF 2.0 (.glb) from Rhino")),
    (b"\xFF\xFE\xFF\x0E", kind("a model of SketchUp", "export glTF 2.0 (.glb) from SketchUp")),
    (b"ISO-10303-21;", kind("a CAD model without triangles", "export STL or glTF 2.0")),
    (b"GIF8", kind("a GIF image", TO_PNG)),
    (b"II*\0", TIFF),
    (b"MM\0*", TIFF),
    (b"8BPS", kind("an image of Photoshop", TO_PNG)),
    (b"DDS ", kind("a DDS image", TO_PNG)),
    (b"\xABKTX ", kind("a KTX image", TO_PNG)),
    (b"\0\0\0\x0CjP  ", kind("a JPEG 2000 image", TO_PNG)),
    (b"\0\0\0\x0CJXL ", kind("a JPEG XL image", TO_PNG)),
    (b"\x89PNG\r\n", image("a PNG image")),
    (b"\xFF\xD8\xFF", image("a JPEG image")),
    (b"#?RADIANCE", image("a Radiance HDR image")),
    (b"#?RGBE", image("a Radiance HDR image")),
    (b"\x76\x2F\x31\x01", image("an OpenEXR image")),
    (b"glTF", GLB),
    (b"ply\n", PLY),
    (b"ply\r", PLY),
];

/// Kinds of texts that begin with `<`, and a word within their first bytes.
const ELEMENTS: [(&[u8], FileKind); 6] = [
    (b"<!doctype html", PAGE),
    (b"<html", PAGE),
    (b"<collada", kind("a COLLADA scene", FROM_BLENDER)),
    (b"<x3d", kind("an X3D scene", FROM_BLENDER)),
    (b"<svg", kind("an SVG drawing", TO_PNG)),
    (b"<error>", kind("a server's message in XML", AGAIN)),
];

/// Returns the kind of a file with these bytes, if its first bytes tell it.
pub fn file_kind(bytes: &[u8]) -> Option<FileKind> {
    if bytes.is_empty() {
        return Some(EMPTY);
    }
    if let Some((_, kind)) = STARTS.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Some(*kind);
    }
    let length = |at: usize| bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes);
    let states_its_length = |at: usize| length(at).is_some_and(|length| length as usize == bytes.len());
    let head = &bytes[..bytes.len().min(HEAD)];
    match head {
        [b'M', b'M', ..] if states_its_length(2) => Some(kind("a scene of 3D Studio", FROM_BLENDER)),
        [b'B', b'M', ..] if states_its_length(2) => Some(image("a BMP image")),
        _ if head.starts_with(b"RIFF") && head.get(8..12) == Some(b"WEBP") => Some(image("a WebP image")),
        _ if head.get(4..8) == Some(b"ftyp") => Some(kind("a HEIF, AVIF or video file", TO_PNG)),
        _ if head.get(257..262) == Some(b"ustar") => {
            Some(kind("a tar archive", "unpack it with `tar -xf`, and name a file in it"))
        }
        _ => {
            let text =
                head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head).trim_ascii_start().to_ascii_lowercase();
            let has = |word: &[u8]| text.windows(word.len()).any(|part| part == word);
            let element = ELEMENTS.iter().find(|(word, _)| text.starts_with(b"<") && has(word));
            element.map(|(_, kind)| *kind)
        }
    }
}

/// Returns a text in UTF-16 as UTF-8 without its mark; `None` for other texts.
///
/// A text without a mark begins with several characters of ASCII.
pub fn from_utf16(bytes: &[u8]) -> Option<String> {
    let head = bytes[..bytes.len().min(16)].as_chunks::<2>().0;
    let is_ascii = |byte: u8| byte != 0 && byte.is_ascii();
    let (is_big, text) = match bytes {
        [0xFF, 0xFE, text @ ..] => (false, text),
        [0xFE, 0xFF, text @ ..] => (true, text),
        [_, 0, _, 0, ..] if head.iter().all(|&[low, high]| is_ascii(low) && high == 0) => (false, bytes),
        [0, _, 0, _, ..] if head.iter().all(|&[high, low]| is_ascii(low) && high == 0) => (true, bytes),
        _ => return None,
    };
    let unit = |&pair: &[u8; 2]| if is_big { u16::from_be_bytes(pair) } else { u16::from_le_bytes(pair) };
    let units = text.as_chunks::<2>().0.iter().map(unit);
    Some(char::decode_utf16(units).map(|char| char.unwrap_or(char::REPLACEMENT_CHARACTER)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn what(bytes: &[u8]) -> &'static str {
        file_kind(bytes).map_or("", |kind| kind.what)
    }

    #[test]
    fn first_bytes_tell_what_a_file_is() {
        for (bytes, expected) in [
            (&b""[..], "an empty file"),
            (b"version https://git-lfs.github.com/spec/v1\noid sha256:4d\n", "a pointer of Git LFS"),
            (b"\n<!DOCTYPE HTML><body>404", "an HTML page"),
            (b"<?xml version=\"1.0\"?>\n<html xmlns=\"x\">", "an HTML page"),
            (b"\x1F\x8B\x08\0", "a file compressed with gzip"),
            (b"PK\x03\x04\x14", "a zip archive"),
            (b"<?xml version=\"1.0\"?><COLLADA>", "a COLLADA scene"),
            (b"MM\x0A\0\0\0\0\0\0\0", "a scene of 3D Studio"),
            (b"glTF\x02\0\0\0", "a binary glTF model"),
            (b"\x89PNG\r\n\x1A\n", "a PNG image"),
            (b"solid a\n", ""),
            (b"# obj\nv 0 0 0\n", ""),
            (b"<scene version=\"3.0.0\"/>", ""),
            (b"MM", ""),
        ] {
            assert_eq!(what(bytes), expected, "{}", String::from_utf8_lossy(bytes));
        }
        let image = file_kind(b"\x89PNG\r\n\x1A\n").unwrap();
        assert!(image.is_read_as("png") && image.is_read_as("hdr") && !image.is_read_as("stl"));
        let model = file_kind(b"glTF\x02\0\0\0").unwrap();
        assert!(model.is_read_as("gltf") && !model.is_read_as("obj"));
    }

    #[test]
    fn texts_of_utf_16_are_read_in_both_orders() {
        let text = "v 0 0 0 # Tür 🚪\n";
        for mark in ["\u{feff}", ""] {
            let units: Vec<u16> = format!("{mark}{text}").encode_utf16().collect();
            let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
            let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
            assert_eq!(
                [&little, &big].map(|bytes| from_utf16(bytes)),
                [Some(text.to_owned()), Some(text.to_owned())]
            );
        }
        assert_eq!(from_utf16(text.as_bytes()), None);
        assert_eq!(from_utf16(b"\0\0\0\0\0\0\0\0"), None);
    }
}
