//! Random number streams of a trial: one ChaCha8 stream per purpose, keyed by the position of the trial in a study. No
//! generator is shared, so any trial can be repeated alone, on any thread, with identical bits, and a new source of
//! noise does not change the random numbers of other sources.
//!
//! Source: Bernstein (2008), ChaCha, a variant of Salsa20.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

/// Purpose of random numbers. The discriminants are part of every published result: never change or reuse a
/// discriminant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u16)]
pub enum RngPurpose {
    /// Noise of the recorded heading.
    Heading = 0,
    /// Noise of the heading display that the helmsman reads.
    Display = 1,
    /// Noise of the yaw-rate sensor.
    YawRate = 2,
    /// Noise of the rudder feedback.
    Rudder = 3,
    /// Jitter of the sampling instants.
    Jitter = 4,
    /// Single lost rows.
    DropOut = 5,
    /// Bursts of lost rows.
    Burst = 6,
    /// Gusting of the steady wind.
    WindGust = 7,
    /// Gusts as a yaw moment.
    Gust = 8,
    /// Random walk of the yaw moment.
    RandomWalk = 9,
    /// Waves declared as a disturbance.
    Waves = 10,
    /// Waves that belong to the response model of the ship, one index per effect.
    EffectWaves = 11,
    /// Values of the specification, varied at random from trial to trial by a study.
    Specification = 12,
    /// Seed of a randomised identification method for this trial.
    Method = 13,
    /// Coloured error of the compass, one index for the record and one for the display.
    HeadingWander = 14,
    /// Spikes of the recorded heading.
    HeadingSpikes = 15,
}

impl RngPurpose {
    /// All purposes, in the order of their discriminants.
    pub const ALL: [Self; 16] = [
        Self::Heading,
        Self::Display,
        Self::YawRate,
        Self::Rudder,
        Self::Jitter,
        Self::DropOut,
        Self::Burst,
        Self::WindGust,
        Self::Gust,
        Self::RandomWalk,
        Self::Waves,
        Self::EffectWaves,
        Self::Specification,
        Self::Method,
        Self::HeadingWander,
        Self::HeadingSpikes,
    ];
}

/// Key of one trial in a study, which determines all its random numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct StreamKey {
    /// Seed of the study.
    pub seed: u64,
    /// Cell of the design.
    pub cell: u64,
    /// Replicate within the cell.
    pub replicate: u64,
}

impl StreamKey {
    /// Generator for one purpose, at its beginning.
    pub fn rng(&self, purpose: RngPurpose) -> ChaCha8Rng {
        self.indexed_rng(purpose, 0)
    }

    /// Generator for one of several sources with the same purpose, at its beginning.
    pub fn indexed_rng(&self, purpose: RngPurpose, index: u32) -> ChaCha8Rng {
        // The 256-bit key of the cipher is the concatenation of seed, cell and replicate, followed by zeros; the stream
        // number contains purpose and index. No hash is used, so no two streams coincide.
        let mut key = [0; 32];
        for (bytes, number) in key.chunks_exact_mut(8).zip([self.seed, self.cell, self.replicate]) {
            bytes.copy_from_slice(&number.to_le_bytes());
        }
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(u64::from(index) << 16 | purpose as u64);
        rng
    }
}

/// Standard normal number.
#[inline]
pub(crate) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    rng.sample(StandardNormal)
}

/// Uniform number in [0, 1).
#[inline]
pub(crate) fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    rng.random()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First two numbers of every stream of one key. They are part of every published result: if this test fails, every
    /// result changes, and the change log must state it.
    #[test]
    fn value_stability() {
        let key = StreamKey { seed: 20, cell: 3, replicate: 7 };
        let draws = RngPurpose::ALL.map(|purpose| {
            let mut rng = key.rng(purpose);
            [rng.random::<u64>(), rng.random::<u64>()]
        });
        assert_eq!(draws, GOLDEN, "drawn {draws:#018x?}");
        let mut rng = key.rng(RngPurpose::Heading);
        assert_eq!([normal(&mut rng), normal(&mut rng)], [0.785_614_548_219_654_8, -0.108_714_680_095_289_06]);
    }

    const GOLDEN: [[u64; 2]; 16] = [
        [0xcefb_61ae_36f3_d6a7, 0x7929_869b_6e05_323f],
        [0x7723_276b_606f_56c4, 0x66b7_6ed2_b5c8_3011],
        [0xa7e0_1fde_49f1_7e1b, 0x9d6e_3310_dbab_5155],
        [0x80b5_d7fe_9687_f7c5, 0xdd68_e2f9_6e07_79f7],
        [0xcce1_76fb_6c5b_3f3c, 0x98c3_4462_2481_1bfc],
        [0xfb3c_7636_642b_f4fd, 0x5c99_9376_94d8_eb30],
        [0x6544_6585_b136_f4f9, 0x74c1_5c6c_a2f8_41f6],
        [0xd987_f7be_976d_766b, 0xcb50_1335_8199_7c24],
        [0x614b_6fef_e3f7_b875, 0xb1b5_092a_9685_0e1c],
        [0x8cbd_0919_a56b_8e9d, 0x4f77_ad19_391f_acb6],
        [0xdf4c_9a52_fa8d_ff38, 0x81cd_6597_1074_8684],
        [0x23ea_fdb1_b171_943d, 0x6984_48ed_daae_e5e9],
        [0x4f35_6280_be9d_7896, 0x23e9_ba16_aa3a_7cb9],
        [0x4094_1b33_b1c2_a1a8, 0xf2c9_075c_959b_33b8],
        [0x0fd6_905a_68d7_dbb0, 0x993f_42f5_bdbc_9f33],
        [0x7f67_eaa5_5561_5440, 0x4099_9c32_3872_43ac],
    ];

    #[test]
    fn every_key_and_purpose_has_a_stream_of_its_own() {
        let key = StreamKey { seed: 1, cell: 2, replicate: 3 };
        let swapped = StreamKey { seed: 2, cell: 1, replicate: 3 };
        let mut first: Vec<u64> = RngPurpose::ALL
            .iter()
            .flat_map(|&purpose| [key.rng(purpose), key.indexed_rng(purpose, 1), swapped.rng(purpose)])
            .map(|mut rng| rng.random())
            .collect();
        first.sort_unstable();
        first.dedup();
        assert_eq!(first.len(), 3 * RngPurpose::ALL.len());
    }

    #[test]
    fn purposes_are_uncorrelated() {
        let key = StreamKey::default();
        let count = 4000;
        let draws = |purpose| {
            let mut rng = key.rng(purpose);
            (0..count).map(|_| normal(&mut rng)).collect::<Vec<f64>>()
        };
        let all = RngPurpose::ALL.map(draws);
        for (i, left) in all.iter().enumerate() {
            for right in &all[i + 1..] {
                let product = left.iter().zip(right).map(|(x, y)| x * y).sum::<f64>() / f64::from(count);
                // 120 pairs: four standard errors.
                assert!(product.abs() < 4.0 / f64::from(count).sqrt());
            }
        }
    }
}
