//! How fast logs are read.

use std::time::Instant;

use super::super::frame::Fields;
use super::*;

/// `--release -- --ignored --nocapture` shows it.
#[test]
#[ignore = "a measurement"]
fn speed() {
    let mut logs = [String::new(), String::new()];
    for k in 0..300_000_u32 {
        let angle = f64::from(k % 3600) / 10.0;
        let rudder = f64::from(k % 70) - 35.0;
        let mut bodies = vec![
            format!("HEHDT,{angle:.2},T"),
            format!("IIRSA,{rudder:.1},A,,V"),
            format!("TIROT,{rudder:.2},A"),
            format!("IIMWV,{angle:.1},R,12.3,N,A"),
        ];
        let second = k / 10;
        let time = format!("{:02}{:02}{:02}.00", second / 3600 % 24, second / 60 % 60, second % 60);
        if k % 10 == 0 {
            let day = 20 + second / 86_400;
            bodies.insert(0, format!("GPRMC,{time},A,5400.1234,N,01000.5678,E,10.0,90.0,{day}1126,1.5,E,A"));
            bodies.push(format!("GPGGA,{time},5400.1234,N,01000.5678,E,1,08,0.9,12.4,M,46.9,M,,"));
            bodies.push(format!("VWVHW,{angle:.1},T,,M,12.5,N,23.2,K"));
            bodies.push("GPGSV,3,1,11,03,03,111,00,04,15,270,00,06,01,010,00,13,06,292,00".to_owned());
        }
        for body in bodies {
            let line = summed(&body);
            logs[0].push_str(&format!("{line}\r\n"));
            let (hour, minute) = (second / 3600 % 24, second / 60 % 60);
            let stamp = format!("2026-11-{:02}T{hour:02}:{minute:02}", 20 + second / 86_400);
            logs[1].push_str(&format!("{stamp}:{:02}.{}00Z {line}\r\n", second % 60, k % 10));
        }
    }
    for (name, log) in ["GPS clock", "stamps"].iter().zip(&logs) {
        let (megabytes, lines) = (log.len() as f64 / 1e6, log.lines().count() as f64);
        let show = |what: &str, run: &dyn Fn()| {
            let best = (0..5).map(|_| {
                let begin = Instant::now();
                run();
                begin.elapsed().as_secs_f64()
            });
            let seconds = best.fold(f64::INFINITY, f64::min);
            let (rate, sentences) = (megabytes / seconds, 1e-6 * lines / seconds);
            println!("{name}, {what}: {rate:.0} MB/s, {sentences:.2} million lines a second");
        };
        show("all", &|| {
            std::hint::black_box(read_bytes(log.as_bytes()).expect("a log"));
        });
        show("lines and SHA-256 alone", &|| {
            let mut lines = Lines::new(log.as_bytes(), Encoding::Utf8);
            while lines.next_bytes().expect("lines").is_some() {}
            std::hint::black_box(lines.sha256());
        });
        show("SHA-256 alone", &|| {
            use sha2::{Digest, Sha256};
            std::hint::black_box(Sha256::digest(log.as_bytes()));
        });
        show("framing alone", &|| {
            for line in log.as_bytes().split(|&byte| byte == b'\n') {
                std::hint::black_box(frame(line.trim_ascii_end()));
            }
        });
        show("framing and fields alone", &|| {
            for line in log.as_bytes().split(|&byte| byte == b'\n') {
                if let Line::Sentence(frame) = frame(line.trim_ascii_end()) {
                    std::hint::black_box(Fields::new(frame.body).at(1));
                }
            }
        });
        show("framing of nmea-kit alone", &|| {
            for line in log.lines() {
                let line = &line[line.find('$').unwrap_or(0)..];
                std::hint::black_box(nmea_kit::parse_frame(line).is_ok());
            }
        });
    }
}
