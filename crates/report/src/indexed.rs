//! Pixels as numbers of a palette: a third of the bytes, and half of a packed file. A drawing has few colours but many
//! shades of them where the edge of a line crosses a pixel, so shades that nobody can tell apart are merged.

use std::collections::HashMap;
use std::iter::repeat_n;

/// Most colours of a palette.
const MOST: usize = 256;

/// The largest deviation of a merged shade from what was drawn, in each of red, green and blue, of 255.
pub(crate) const DEVIATION: u8 = 4;

/// A colour of at least one pixel in so many fills an area or a line, is no shade of an edge, and stays what it is.
const FLAT: usize = 2000;

type Rgb = [u8; 3];

/// An image with a palette.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Indexed {
    /// The colours, red, green and blue of each in turn.
    pub palette: Vec<u8>,
    /// Bits of a pixel: 1, 2, 4 or 8.
    pub bits: u8,
    /// Rows of pixels, each beginning with a new byte, the first pixel in its highest bits.
    pub rows: Vec<u8>,
}

/// An opaque image of `width` pixels a row, of 8-bit red, green, blue and opacity each, with a palette: without loss
/// where it has no more than 256 colours, otherwise with the smallest deviation up to [`DEVIATION`] that leaves no
/// more. `None` where that does not suffice.
pub(crate) fn indexed(pixels: &[[u8; 4]], width: usize) -> Option<Indexed> {
    let mut counts: Vec<(Rgb, usize)> = Vec::new();
    let mut numbers: HashMap<[u8; 4], u16> = HashMap::new();
    let mut of_pixels: Vec<u16> = Vec::with_capacity(pixels.len());
    for run in pixels.chunk_by(|one, next| one == next) {
        let colour = run[0];
        // Much of a drawing is as the row above, which is faster to look at.
        let above = of_pixels.len().checked_sub(width).filter(|&above| pixels[above] == colour);
        let number = match above {
            Some(above) => of_pixels[above],
            None => *numbers.entry(colour).or_insert(u16::try_from(counts.len()).ok()?),
        };
        if usize::from(number) == counts.len() {
            let [red, green, blue, _] = colour;
            counts.push(([red, green, blue], 0));
        }
        counts[usize::from(number)].1 += run.len();
        of_pixels.extend(repeat_n(number, run.len()));
    }
    let merged = |deviation| merged(&counts, pixels.len(), deviation);
    let coarse = merged(DEVIATION)?;
    let (palette, places) = (0..DEVIATION).find_map(merged).unwrap_or(coarse);
    let of_pixels: Vec<u8> = of_pixels.into_iter().map(|number| places[usize::from(number)]).collect();
    let bits = [1, 2, 4].into_iter().find(|bits| palette.len() <= 1 << bits).unwrap_or(8);
    let packed =
        |some: &[u8]| some.iter().enumerate().fold(0, |byte, (i, place)| byte | place << (8 - bits * (i as u8 + 1)));
    let rows = match bits {
        8 => of_pixels,
        _ => of_pixels.chunks(width).flat_map(|row| row.chunks(8 / usize::from(bits)).map(packed)).collect(),
    };
    Some(Indexed { palette: palette.concat(), bits, rows })
}

/// A palette of at most 256 colours that shows each of those counted no more than `deviation` from itself, and where in
/// it each is.
fn merged(counts: &[(Rgb, usize)], pixels: usize, deviation: u8) -> Option<(Vec<Rgb>, Vec<u8>)> {
    let (flat, mut shades): (Vec<usize>, Vec<usize>) =
        (0..counts.len()).partition(|&number| counts[number].1 * FLAT >= pixels);
    // Neighbours on the way from one flat colour to another follow each other.
    shades.sort_by_key(|&number| (counts[number].0.iter().map(|&part| u32::from(part)).sum::<u32>(), counts[number].0));
    // The least and the largest part of what is merged.
    let mut boxes: Vec<[Rgb; 2]> = flat.iter().map(|&number| [counts[number].0; 2]).collect();
    let mut places = vec![0; counts.len()];
    for (order, &number) in flat.iter().chain(&shades).enumerate() {
        let colour = counts[number].0;
        let with = |[least, most]: [Rgb; 2]| {
            let join = |part: usize| (least[part].min(colour[part]), most[part].max(colour[part]));
            let ends = [0, 1, 2].map(join);
            [ends.map(|(least, _)| least), ends.map(|(_, most)| most)]
        };
        let is_within = |range: [Rgb; 2], room: u8| (0..3).all(|part| range[1][part] - range[0][part] <= room);
        let found = if order < flat.len() {
            Some(order)
        } else {
            boxes.iter().enumerate().position(|(i, &range)| {
                is_within(with(range), if i < flat.len() { deviation } else { deviation.saturating_mul(2) })
            })
        };
        let found = found.unwrap_or(boxes.len());
        if found == boxes.len() {
            boxes.push([colour; 2]);
        } else if found >= flat.len() {
            boxes[found] = with(boxes[found]);
        }
        places[number] = u8::try_from(found).ok()?;
    }
    let middle = |[least, most]: [Rgb; 2]| [0, 1, 2].map(|part| least[part].midpoint(most[part]));
    (boxes.len() <= MOST).then(|| (boxes.into_iter().map(middle).collect(), places))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(image: &Indexed, width: usize) -> Vec<Rgb> {
        let per_byte = 8 / usize::from(image.bits);
        let mask = ((1_u16 << image.bits) - 1) as u8;
        let number = |row: &[u8], x: usize| {
            let shift = 8 - image.bits - (x % per_byte) as u8 * image.bits;
            usize::from((row[x / per_byte] >> shift) & mask)
        };
        let pixels = image.rows.chunks(width.div_ceil(per_byte)).flat_map(|row| (0..width).map(|x| number(row, x)));
        pixels.map(|number| [0, 1, 2].map(|part| image.palette[3 * number + part])).collect()
    }

    fn opaque(pixels: impl Iterator<Item = Rgb>) -> Vec<[u8; 4]> {
        pixels.map(|[red, green, blue]| [red, green, blue, 255]).collect()
    }

    #[test]
    fn few_colours_are_kept_as_they_are() {
        for (colours, bits) in [(1, 1), (2, 1), (3, 2), (16, 4), (17, 8), (256, 8)] {
            let pixels = opaque((0..777).map(|i| [(i % colours) as u8, 7, 255 - (i % colours) as u8]));
            let image = indexed(&pixels, 37).unwrap();
            assert_eq!((image.bits, image.palette.len()), (bits, 3 * colours));
            assert!(shown(&image, 37).iter().zip(&pixels).all(|(shown, drawn)| shown[..] == drawn[..3]));
        }
    }

    #[test]
    fn shades_are_merged_no_further_than_is_said() {
        let shades = |i: u32| [(i % 97) as u8 * 2, (i % 97) as u8 + (i % 7) as u8, 9];
        let flat = [1, 250, 3];
        let pixels = opaque((0..60_000).map(|i| if i % 8 > 0 { flat } else { shades(i / 8) }));
        let image = indexed(&pixels, 300).unwrap();
        assert_eq!(image, indexed(&pixels, 300).unwrap());
        let shown = shown(&image, 300);
        let deviation =
            shown.iter().zip(&pixels).flat_map(|(shown, drawn)| (0..3).map(|part| shown[part].abs_diff(drawn[part])));
        let deviation = deviation.max();
        assert!(deviation > Some(0) && deviation <= Some(DEVIATION), "{deviation:?}");
        assert_eq!(shown.iter().filter(|pixel| **pixel == flat).count(), 52_500, "what fills an area is not touched");
    }

    #[test]
    fn too_many_colours_have_no_palette() {
        let pixels = opaque((0..40_000_u32).map(|i| [(i % 200) as u8, (i / 200) as u8, 0]));
        assert_eq!(indexed(&pixels, 200), None);
    }
}
