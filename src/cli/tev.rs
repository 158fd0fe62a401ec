//! The viewer tev: a thread sends it what is rendered so far, by its protocol over TCP.
//!
//! Rendering never waits for the viewer. The thread takes a new copy of the image when the former one is sent, so that
//! a slow viewer gets fewer copies. At the end, the run waits a short time for the last image.

use super::beside::spacing;
use super::talk;
use base::film::Image;
use base::live::LiveImage;
use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};
use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};

/// Minimum time between copies.
const INTERVAL: Duration = Duration::from_secs(1);
/// Time after which a viewer that takes no data counts as lost.
const TIMEOUT: Duration = Duration::from_secs(1);
/// Time after which a lost viewer is looked for again.
const RETRY: Duration = Duration::from_secs(10);
/// Maximum time that the end of a run waits for the last image, as long as the viewer takes data.
const GRACE: Duration = Duration::from_secs(10);
/// Number of orders that may wait; further ones are dropped.
const WAITING: usize = 4;
/// Approximate number of pixels in a packet.
const PACKET_PIXELS: usize = 1 << 16;
/// Channels of an image.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// The thread that sends images.
pub struct Tev {
    orders: Option<SyncSender<Order>>,
    /// Number of packets that were sent.
    packets: Arc<AtomicU64>,
    /// Channel that closes when the thread ends.
    ended: Receiver<()>,
}

enum Order {
    /// Send an image in the making at intervals.
    Watch(Arc<LiveImage>),
    /// Send an image.
    Show(Image),
}

impl Tev {
    /// Starts the thread, which sends images to `address` under a name. `threads` are at work on rendering.
    pub fn start(address: String, name: String, threads: u32) -> Tev {
        let (orders, inbox) = sync_channel(WAITING);
        let (alive, ended) = channel();
        let packets = Arc::<AtomicU64>::default();
        let mut sender = Sender {
            address,
            name,
            threads,
            packets: Arc::clone(&packets),
            client: None,
            retry: None,
            pause: INTERVAL,
            has_warned: false,
        };
        thread::spawn(move || {
            sender.run(&inbox);
            drop(alive);
        });
        Tev { orders: Some(orders), packets, ended }
    }

    /// Sends an image in the making at intervals.
    pub fn watch(&self, live: &Arc<LiveImage>) {
        self.order(Order::Watch(Arc::clone(live)));
    }

    /// Sends an image.
    pub fn show(&self, image: &Image) {
        self.order(Order::Show(image.clone()));
    }

    fn order(&self, order: Order) {
        if let Some(orders) = &self.orders {
            // A viewer that is behind misses images.
            let _ = orders.try_send(order);
        }
    }
}

impl Drop for Tev {
    fn drop(&mut self) {
        drop(self.orders.take());
        let begun = Instant::now();
        let mut sent = None;
        // A thread that is not ready by then ends with the process.
        while begun.elapsed() < GRACE {
            let now = Some(self.packets.load(Ordering::Relaxed));
            if sent == now || self.ended.recv_timeout(TIMEOUT) != Err(RecvTimeoutError::Timeout) {
                break;
            }
            sent = now;
        }
    }
}

/// State of the thread.
struct Sender {
    address: String,
    name: String,
    threads: u32,
    packets: Arc<AtomicU64>,
    /// The viewer, with the size of the image that it has; `None` if it is not connected.
    client: Option<(TevClient, [u32; 2])>,
    /// Time before which a lost viewer is not looked for.
    retry: Option<Instant>,
    /// Time to the next copy.
    pause: Duration,
    has_warned: bool,
}

impl Sender {
    fn run(&mut self, inbox: &Receiver<Order>) {
        let (mut watched, mut sent): (Option<Arc<LiveImage>>, u64) = (None, 0);
        loop {
            match inbox.recv_timeout(self.pause) {
                Ok(Order::Watch(live)) => (watched, sent) = (Some(live), 0),
                Ok(Order::Show(image)) => {
                    watched = None;
                    self.send(&image);
                }
                Err(RecvTimeoutError::Timeout) => {
                    let Some(live) = &watched else { continue };
                    let begun = Instant::now();
                    let changes = live.changes();
                    if changes != sent
                        && let Some(copy) = live.copy()
                    {
                        self.send(&copy.image);
                        sent = changes;
                    }
                    self.pause = INTERVAL.max(spacing(begun.elapsed(), self.threads));
                }
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// Sends an image, unless the viewer was lost a short time ago.
    fn send(&mut self, image: &Image) {
        if self.retry.is_some_and(|retry| Instant::now() < retry) {
            return;
        }
        if let Err(error) = self.try_to_send(image) {
            // A packet may be there in part, which ends the connection.
            self.client = None;
            self.retry = Some(Instant::now() + RETRY);
            if !self.has_warned {
                self.has_warned = true;
                let address = &self.address;
                talk::warning(&format!("tev at {address}: {}; rendering goes on without it", reason(&error)));
            }
        }
    }

    fn try_to_send(&mut self, image: &Image) -> io::Result<()> {
        let (name, size) = (&*self.name, [image.width, image.height]);
        let client = match &mut self.client {
            Some((client, known)) if *known == size => client,
            _ => {
                let mut client = TevClient::wrap(connect(&self.address)?);
                let [width, height] = size;
                let create = PacketCreateImage {
                    image_name: name,
                    grab_focus: true,
                    width,
                    height,
                    channel_names: &CHANNELS,
                };
                client.send(create)?;
                &mut self.client.insert((client, size)).0
            }
        };
        let rows = (PACKET_PIXELS / image.width.max(1) as usize).max(1);
        let bands = image.pixels.chunks(rows * image.width.max(1) as usize);
        for (band, y) in bands.zip((0..).step_by(rows)) {
            let data: Vec<f32> = band.iter().flat_map(|pixel| pixel.to_array()).collect();
            client.send(PacketUpdateImage {
                image_name: name,
                grab_focus: false,
                channel_names: &CHANNELS,
                channel_offsets: &[0, 1, 2],
                channel_strides: &[3, 3, 3],
                x: 0,
                y,
                width: image.width,
                height: (band.len() / image.width as usize) as u32,
                data: &data,
            })?;
            self.packets.fetch_add(1, Ordering::Relaxed);
        }
        Ok(())
    }
}

/// Connects to the first address that answers.
fn connect(address: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::other("the host has no address");
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, TIMEOUT) {
            Ok(stream) => {
                stream.set_write_timeout(Some(TIMEOUT))?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Returns the reason of an error for users.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::ConnectionRefused => "no viewer listens there".to_owned(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => "it does not answer".to_owned(),
        _ => error.to_string(),
    }
}
