//! The viewer tev: what it is sent, and viewers that are absent, hang or die.
//!
//! Packets as tev documents them: the length of the whole packet in 32 bits, a byte for the kind, and the content. All
//! numbers are little-endian, texts end in a zero byte.

use super::{Finished, Sandbox, read};
use lightsplat::film::read_exr;
use std::io::{ErrorKind, Read};
use std::net::{TcpListener, TcpStream};
use std::thread::{self, JoinHandle};

/// Kinds of packets.
const CREATE_IMAGE: u8 = 4;
const UPDATE_IMAGE_V3: u8 = 6;

/// A packet under inspection.
struct Packet<'a>(&'a [u8]);

impl Packet<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_first_chunk().unwrap();
        self.0 = rest;
        *head
    }

    fn byte(&mut self) -> u8 {
        let [byte] = self.bytes();
        byte
    }

    fn number(&mut self) -> i32 {
        i32::from_le_bytes(self.bytes())
    }

    fn long(&mut self) -> i64 {
        i64::from_le_bytes(self.bytes())
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|byte| *byte == 0).unwrap();
        let text = String::from_utf8(self.0[..end].to_vec()).unwrap();
        self.0 = &self.0[end + 1..];
        text
    }
}

/// An image as a viewer holds it.
#[derive(Debug, Default, PartialEq)]
struct Viewed {
    name: String,
    size: [i32; 2],
    /// Radiance by channel.
    channels: Vec<Vec<f32>>,
    updates: usize,
}

/// Receives all packets of a connection as tev does.
fn view(mut stream: TcpStream) -> Viewed {
    let mut viewed = Viewed::default();
    loop {
        let mut length = [0; 4];
        match stream.read_exact(&mut length) {
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return viewed,
            read => read.unwrap(),
        }
        let mut content = vec![0; u32::from_le_bytes(length) as usize - 4];
        stream.read_exact(&mut content).unwrap();
        let mut packet = Packet(&content);
        match packet.byte() {
            CREATE_IMAGE => {
                assert!(packet.byte() <= 1, "grab focus");
                let name = packet.text();
                let size = [packet.number(), packet.number()];
                let count = packet.number();
                let names: Vec<String> = (0..count).map(|_| packet.text()).collect();
                assert_eq!(names, ["R", "G", "B"]);
                let pixels = size.iter().product::<i32>() as usize;
                viewed = Viewed { name, size, channels: vec![vec![0.0; pixels]; 3], updates: 0 };
            }
            UPDATE_IMAGE_V3 => {
                assert!(packet.byte() <= 1, "grab focus");
                assert_eq!(packet.text(), viewed.name);
                let count = packet.number();
                let names: Vec<String> = (0..count).map(|_| packet.text()).collect();
                assert_eq!(names, ["R", "G", "B"]);
                let [x, y, width, height] = [(); 4].map(|()| packet.number());
                let [offsets, strides] = [(); 2].map(|()| [(); 3].map(|()| packet.long()));
                let data: Vec<f32> =
                    packet.0.chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
                let pixels = i64::from(width * height);
                let needed =
                    offsets.iter().zip(&strides).map(|(offset, stride)| offset + (pixels - 1) * stride + 1);
                assert_eq!(needed.max(), Some(data.len() as i64));
                for (channel, (offset, stride)) in
                    viewed.channels.iter_mut().zip(offsets.iter().zip(&strides))
                {
                    for pixel in 0..pixels {
                        let (column, row) = (pixel as i32 % width + x, pixel as i32 / width + y);
                        assert!(column < viewed.size[0] && row < viewed.size[1]);
                        channel[(row * viewed.size[0] + column) as usize] =
                            data[(offset + pixel * stride) as usize];
                    }
                }
                viewed.updates += 1;
                packet.0 = &[];
            }
            other => panic!("packet of kind {other}"),
        }
        assert!(packet.0.is_empty(), "bytes are left over");
    }
}

/// Listens on a free port; returns its option, and the thread that runs `serve` with the first connection.
fn viewer<R: Send + 'static>(serve: impl FnOnce(TcpStream) -> R + Send + 'static) -> (String, JoinHandle<R>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let option = format!("--tev={}", listener.local_addr().unwrap());
    (option, thread::spawn(move || serve(listener.accept().unwrap().0)))
}

/// Renders the room to `a.exr`, large enough that no buffer of a connection holds it.
fn render(sandbox: &Sandbox, more: &[&str]) -> Finished {
    let large = ["--resolution", "800x600", "--spp", "1", "--no-png", "--reproducible"];
    sandbox.run(&[&["render", "room.xml", "-o", "a.exr", "--method", "path"], &large[..], more].concat())
}

#[test]
fn the_viewer_gets_the_image_by_the_documented_packets() {
    let sandbox = Sandbox::new();
    let (option, viewed) = viewer(view);
    let stderr = render(&sandbox, &[&option]).expect(0).stderr;
    let viewed = viewed.join().unwrap();
    assert_eq!((&*viewed.name, viewed.size), ("a.exr", [800, 600]), "{stderr}");
    assert!(viewed.updates > 1, "an image of this size takes several packets");
    let image = read_exr(&sandbox.path("a.exr")).unwrap();
    for (channel, values) in viewed.channels.iter().enumerate() {
        let own = image.pixels.iter().map(|pixel| pixel[channel]);
        assert!(own.eq(values.iter().copied()), "channel {channel}");
    }
}

#[test]
fn viewers_that_are_absent_hang_or_die_change_and_end_nothing() {
    let sandbox = Sandbox::new();
    render(&sandbox, &[]).expect(0);
    let plain = read(&sandbox.path("a.exr"));
    let (hanging, held) = viewer(|stream| stream);
    let (dying, dead) = viewer(|mut stream| {
        let mut start = [0; 10];
        stream.read_exact(&mut start).unwrap();
    });
    let (absent, listener) = {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        (format!("--tev={}", listener.local_addr().unwrap()), listener)
    };
    drop(listener);
    for option in [&hanging, &dying, &absent] {
        let stderr = render(&sandbox, &[option]).expect(0).stderr;
        assert!(stderr.matches("rendering goes on without it").count() <= 1, "{stderr}");
        assert!(read(&sandbox.path("a.exr")) == plain, "{option}");
    }
    held.join().unwrap();
    dead.join().unwrap();
    let stderr = render(&sandbox, &[&absent]).expect(0).stderr;
    assert!(stderr.contains("no viewer listens there; rendering goes on without it"), "{stderr}");
}
