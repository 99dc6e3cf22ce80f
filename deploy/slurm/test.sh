#!/bin/bash
# Proves that a study split over a cluster gives the rows of one run, byte for byte, also when a task is killed in the middle.
#
# With Slurm installed (Debian: slurm-wlm; as root) a private one-node Slurm is started, used through the scripts of this
# folder and taken down again. Without it the same shards run as processes. Takes a quarter of a minute.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
here=$root/deploy/slurm
export STUDY=${STUDY:-$root/target/release/study}
[ -x "$STUDY" ] || { echo "test.sh: build the program first: cargo build --release -p study" >&2; exit 2; }
scenario=$here/one-node/study.toml
shards=6
work=$(mktemp -d)
out=$work/result

stop() {
  for name in slurmd slurmctld munged; do
    if [ -s "$work/$name.pid" ]; then kill "$(cat "$work/$name.pid")" 2> /dev/null || true; fi
  done
  sleep 0.5
  rm -rf "$work"
}
trap stop EXIT

same() {
  cmp "$work/whole/rows.parquet" "$out/rows.parquet" && echo "test.sh: passed with $1: $shards shards, one of them killed, give the rows of one run"
}

killed() {
  [ ! -e "$out/shards/2-of-$shards/rows.parquet" ] || { echo "test.sh: shard 2 was over before it was killed" >&2; exit 1; }
}

has_slurm() {
  [ "$(id -u)" -eq 0 ] || return 1
  for program in sbatch srun scontrol slurmctld slurmd munged mungekey; do
    command -v "$program" > /dev/null || return 1
  done
}

start_slurm() {
  mkdir -p "$work/state" "$work/spool"
  chmod 755 "$work"
  mungekey --create --keyfile "$work/munge.key"
  munged --force --key-file "$work/munge.key" --socket "$work/munge.socket" --pid-file "$work/munged.pid" \
    --log-file "$work/munged.log" --seed-file "$work/munge.seed"
  sed -e "s|@HOST@|$(hostname -s)|g" -e "s|@STATE@|$work|g" -e "s|@CPUS@|$(nproc)|g" "$here/one-node/slurm.conf.in" > "$work/slurm.conf"
  export SLURM_CONF=$work/slurm.conf
  slurmctld -c
  slurmd -c
  for _ in $(seq 50); do
    sinfo -h -o %T 2> /dev/null | grep -q idle && return
    sleep 0.2
  done
  echo "test.sh: Slurm did not start; $(tail -3 "$work"/slurm*.log)" >&2
  return 1
}

wait_for() {
  while squeue -h -j "$1" 2> /dev/null | grep -q .; do sleep 0.3; done
}

"$STUDY" "$scenario" --out "$work/whole" --quiet

if has_slurm && start_slurm; then
  cd "$work"
  # As two arrays, the first of four.
  jobs=$(LARGEST=4 "$here/submit.sh" "$scenario" "$out" "$shards" --cpus-per-task=1 --time=10)
  echo "$jobs"
  array=${jobs#array } array=${array%%,*} array=${array// /,}
  merge=${jobs##*merge }
  # Kill the process of one task as a crash would, once it has stored something.
  until compgen -G "$out/shards/2-of-$shards/unfinished/*.parquet" > /dev/null; do sleep 0.05; done
  # The folder is new, so no process but those of this task names it.
  pgrep -f -- "--shard 2/$shards --out $out/" | xargs -r kill -KILL || true
  wait_for "$array"
  scancel "$merge" 2> /dev/null || true
  killed
  # The array has failed in one task, so its merge never runs; that task alone is submitted again.
  again=$(SHARDS=$shards sbatch --parsable --array=2 --cpus-per-task=1 --time=10 "$here/study.sbatch" "$scenario" "$out")
  wait_for "$again"
  wait_for "$(sbatch --parsable --dependency="afterok:$again" --time=10 --cpus-per-task=1 "$here/merge.sbatch" "$out")"
  same Slurm
else
  # In the place of the shell that runs in the background, so that its number is the number of the program.
  run() { exec "$STUDY" "$scenario" --shard "$1/$shards" --out "$out/shards/$1-of-$shards" --threads 1 --quiet; }
  run 2 & victim=$!
  until compgen -G "$out/shards/2-of-$shards/unfinished/*.parquet" > /dev/null; do sleep 0.05; done
  kill -KILL "$victim"
  wait "$victim" 2> /dev/null || true
  killed
  running=()
  for shard in $(seq "$shards"); do run "$shard" & running+=($!); done
  for process in "${running[@]}"; do wait "$process"; done
  "$STUDY" merge "$out"/shards/* --out "$out" --quiet
  same processes
fi
