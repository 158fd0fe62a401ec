//! The chart of a race: error over time of each scene, with figures of other programs.

use crate::plot::{Chart, Colour, Line, Panel, Point, Series};
use crate::study::{Answer, PeerFigure};

/// Colours of other programs. The curves of the race have the others.
const COLOURS: [Colour; 6] =
    [Colour::Blue, Colour::Purple, Colour::Orange, Colour::Olive, Colour::Steel, Colour::Grey];

/// Names of the errors that are drawn.
pub const REL_MSE: &str = "relMSE";
pub const FLIP: &str = "FLIP";

/// An error: its name, and its value for an image of another program.
type Error = (&'static str, fn(&PeerFigure) -> Option<f64>);

/// Errors in the order of the panels of a scene.
const ERRORS: [Error; 2] = [(REL_MSE, |peer| peer.rel_mse), (FLIP, |peer| peer.flip)];

/// Description of what the chart shows.
const HOW_TO_READ: &str = "Lower left is better. Each point is an image. A line joins the images of a method that no other \
    image of it beats.";

/// Returns the chart: panels of the answers, then panels of the scenes that only others have rendered.
pub fn chart(answers: &[Answer], peers: &[PeerFigure], conditions: String) -> Chart {
    let mut names: Vec<&str> = Vec::new();
    let mut scenes: Vec<&str> = answers.iter().map(|answer| &*answer.scene).collect();
    let mut notes: Vec<&str> = Vec::new();
    for peer in peers {
        add(&mut names, &peer.name);
        add(&mut scenes, &peer.scene);
        peer.note.iter().for_each(|note| add(&mut notes, note));
    }
    let mut panels = Vec::new();
    for scene in scenes {
        let own = answers.iter().find(|answer| answer.scene == scene);
        let own = own.map_or_else(|| empty(scene), |answer| answer.panels());
        for (mut panel, (_, error)) in own.into_iter().zip(ERRORS) {
            let of_scene: Vec<&PeerFigure> = peers.iter().filter(|peer| peer.scene == scene).collect();
            panel.series.extend(names.iter().enumerate().map(|(i, name)| Series {
                name: (*name).to_owned(),
                colour: COLOURS[i % COLOURS.len()],
                line: Line::Front,
                points: points(of_scene.iter().filter(|peer| peer.name == *name), error),
            }));
            panels.push(panel);
        }
    }
    let caption =
        [HOW_TO_READ.to_owned(), conditions].into_iter().chain(notes.into_iter().map(str::to_owned));
    Chart { axis: "processor seconds", panels, caption: caption.collect() }
}

/// Adds a name that is not there yet.
fn add<'n>(names: &mut Vec<&'n str>, name: &'n str) {
    if !names.contains(&name) {
        names.push(name);
    }
}

/// Returns the panels of a scene that the race has not rendered.
fn empty(scene: &str) -> Vec<Panel> {
    let panel = |(name, _): Error| Panel { title: format!("{scene}: {name}"), series: Vec::new() };
    ERRORS.map(panel).into()
}

fn points<'p>(
    peers: impl Iterator<Item = &'p &'p PeerFigure>,
    error: fn(&PeerFigure) -> Option<f64>,
) -> Vec<Point> {
    let point =
        |peer: &&PeerFigure| Some(Point { x: peer.seconds, y: error(peer)?, name: peer.label.clone() });
    peers.filter_map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_programs_have_their_points_in_the_panels_of_their_scenes() {
        let peer = |name: &str, scene: &str, seconds: f64| PeerFigure {
            name: name.to_owned(),
            scene: scene.to_owned(),
            label: "16 samples".to_owned(),
            seconds,
            psnr: None,
            rel_mse: (name == "A").then_some(0.01),
            flip: Some(0.05),
            note: Some("Measured alone.".to_owned()),
        };
        let peers =
            [peer("A", "knot", 1.0), peer("A", "knot", 2.0), peer("B", "knot", 3.0), peer("B", "nave", 4.0)];
        let chart = chart(&[], &peers, "On a machine.".to_owned());
        let titles: Vec<&str> = chart.panels.iter().map(|panel| &*panel.title).collect();
        assert_eq!(titles, ["knot: relMSE", "knot: FLIP", "nave: relMSE", "nave: FLIP"]);
        let counts = |panel: usize| -> Vec<usize> {
            chart.panels[panel].series.iter().map(|series| series.points.len()).collect()
        };
        assert_eq!([counts(0), counts(1), counts(2), counts(3)], [[2, 0], [2, 1], [0, 0], [0, 1]]);
        assert_eq!(chart.caption[1..], ["On a machine.", "Measured alone."]);
        assert_ne!(chart.panels[0].series[0].colour, chart.panels[0].series[1].colour);
    }
}
