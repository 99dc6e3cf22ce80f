//! Pixels of a drawing as indices into a palette of 256 colours, half the size of an RGB file. Flat colours are
//! unchanged; if there are more colours, shades at the edges of lines and letters are merged.

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

/// Maximum number of colours of a palette with one-byte indices.
const MAX_COLOURS: usize = 256;

/// Number of colours that are never merged: the colours of the largest areas.
const FLAT: usize = 128;

/// Opaque image of few colours.
#[derive(Debug, PartialEq)]
pub(crate) struct IndexedImage {
    /// Red, green and blue of every colour, in descending order of area.
    pub palette: Vec<u8>,
    /// Palette index of every pixel, row by row.
    pub pixels: Vec<u8>,
}

type Rgb = [u8; 3];

impl IndexedImage {
    /// Image of opaque RGBA pixels, four bytes each; the alpha byte is ignored.
    ///
    /// In addition to the colours of large areas, the palette holds the first colour of each combination of levels. The
    /// number of levels per channel is the largest of 256, 128, …, 4 that gives at most 256 colours. Any other colour
    /// becomes the nearest colour of the palette.
    pub fn from_rgba(rgba: &[u8]) -> Self {
        let (pixels, _) = rgba.as_chunks::<4>();
        let runs = || pixels.chunk_by(|p, next| p == next).map(|run| ([run[0][0], run[0][1], run[0][2]], run.len()));
        // An area has neighbours of the same colour, an edge has few.
        let mut areas: HashMap<Rgb, usize> = HashMap::new();
        runs().for_each(|(colour, length)| *areas.entry(colour).or_default() += length - 1);
        let mut colours: Vec<Rgb> = areas.keys().copied().collect();
        colours.sort_unstable_by_key(|colour| (Reverse(areas[colour]), *colour));
        let palette =
            (2..=8).rev().map(|bits| palette(&colours, (1 << bits) - 1)).find(|palette| palette.len() <= MAX_COLOURS);
        let palette = palette.expect("two bits a channel make 64 colours beside the flat ones");
        let places: HashMap<Rgb, u8> = colours.iter().map(|colour| (*colour, nearest(&palette, *colour))).collect();
        let pixels = runs().flat_map(|(colour, length)| std::iter::repeat_n(places[&colour], length)).collect();
        Self { palette: palette.concat(), pixels }
    }
}

/// The flat colours, and the first colour of each combination of levels, from 0 to `levels` in every channel.
fn palette(colours: &[Rgb], levels: u32) -> Vec<Rgb> {
    let level = |channel: u8| (u32::from(channel) * levels + 127) / 255;
    let mut levels_seen = HashSet::new();
    let mut is_kept = |place, colour: &Rgb| levels_seen.insert(colour.map(level)) || place < FLAT;
    let kept = colours.iter().enumerate().filter(|(place, colour)| is_kept(*place, colour));
    kept.map(|(_, colour)| *colour).collect()
}

/// Index of the nearest colour.
fn nearest(palette: &[Rgb], colour: Rgb) -> u8 {
    let distance = |candidate: &Rgb| (0..3).map(|k| u32::from(candidate[k].abs_diff(colour[k])).pow(2)).sum::<u32>();
    let place = palette.iter().enumerate().min_by_key(|(_, colour)| distance(colour)).map_or(0, |(place, _)| place);
    place as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let image = IndexedImage::from_rgba(&[9, 9, 9, 255, 255, 0, 0, 255, 255, 0, 0, 255]);
        assert_eq!(image, IndexedImage { palette: vec![255, 0, 0, 9, 9, 9], pixels: vec![1, 0, 0] });
    }

    #[test]
    fn shades_are_joined_and_areas_are_not() {
        // A ramp of 65 536 colours, and areas of two neighbouring colours.
        let ramp = (0..=u16::MAX).flat_map(|k| [(k >> 8) as u8, (k & 255) as u8, 77, 255]);
        let areas = [[201, 33, 77, 255], [201, 34, 77, 255]].map(|pixel| pixel.repeat(1000)).concat();
        let rgba: Vec<u8> = ramp.chain(areas).collect();
        let IndexedImage { palette, pixels } = IndexedImage::from_rgba(&rgba);
        assert!(
            palette.len() <= 3 * MAX_COLOURS && palette[..6] == [201, 33, 77, 201, 34, 77],
            "{}",
            palette.len() / 3
        );
        let of = |place: &u8| &palette[3 * usize::from(*place)..][..3];
        let apart = |(place, pixel): (&u8, &[u8])| (0..3).map(|k| of(place)[k].abs_diff(pixel[k])).max();
        let farthest = pixels.iter().zip(rgba.chunks_exact(4)).filter_map(apart).max();
        // Eight levels per channel, each with its first colour.
        assert!(farthest.is_some_and(|apart| apart <= 36), "{farthest:?}");
    }
}
