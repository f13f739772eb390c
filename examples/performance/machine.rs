//! What the figures were measured on, and when.

use fieldstone::field::Level;
use std::time::{SystemTime, UNIX_EPOCH};

/// The processor, its threads and the instructions that closures use.
pub fn name() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or("an unknown processor", |(_, name)| name.trim());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "{model} ({threads} threads, closures for {})",
        Level::best().name()
    )
}

/// Today's date, as in 2026-11-22.
pub fn today() -> String {
    date(
        SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |time| time.as_secs() / 86_400),
    )
}

/// The date of a day since 1970.
pub fn date(days: u64) -> String {
    let [year, month, day] = civil(days as i64);
    format!("{year}-{month:02}-{day:02}")
}

/// Year, month and day of a day since 1970. Source: Hinnant, chrono-compatible low-level date algorithms.
fn civil(days: i64) -> [i64; 3] {
    let z = days + 719_468;
    let era = z.div_euclid(146_097);
    let day_of_era = z.rem_euclid(146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let month = if shifted < 10 {
        shifted + 3
    } else {
        shifted - 9
    };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    [year, month, day_of_year - (153 * shifted + 2) / 5 + 1]
}
