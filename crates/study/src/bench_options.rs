//! What a user may ask of `study bench`.

use std::path::PathBuf;

use campaign::benchmark::BenchTask;
use clap::Args;
use scenario::problem::suggestion;

use crate::options::FigureOptions;
use crate::outside::NamedCommand;

/// What `study bench` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct BenchRequest {
    /// Definition of a benchmark of your own [default: zigzag-bench, which is part of the program]
    #[arg(value_name = "BENCH.toml")]
    pub definition: Option<PathBuf>,
    /// Folder with measured records, at any depth [default: $KEMPF_DATA, or ./data]
    #[arg(long, value_name = "DIR")]
    pub data: Vec<PathBuf>,
    /// Methods that take part [default: all]
    #[arg(long = "method", value_name = "ID")]
    pub methods: Vec<String>,
    /// An outside estimator that takes part as well: what it is called, and the command that starts it
    #[arg(long, value_name = "LABEL=COMMAND")]
    pub external: Vec<NamedCommand>,
    /// Tasks that are set [default: all]
    #[arg(long = "task", value_name = "ID", value_parser = task)]
    pub tasks: Vec<BenchTask>,
    /// Sets of records that are used [default: all]
    #[arg(long = "set", value_name = "NAME")]
    pub sets: Vec<String>,
    /// How figures are drawn
    #[command(flatten)]
    pub style: FigureOptions,
}

fn task(name: &str) -> Result<BenchTask, String> {
    BenchTask::ALL.into_iter().find(|task| task.id() == name).ok_or_else(|| {
        let known = BenchTask::ALL.map(BenchTask::id);
        format!("there is no such task; {}", suggestion(name, &known))
    })
}
