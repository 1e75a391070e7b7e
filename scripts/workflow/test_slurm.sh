#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Starts a Slurm of one node on this machine, runs a suite on it with the shipped profile, and checks
# that the results are those of a plain run. Needs root, for Slurm runs jobs as their users; it
# installs slurm-wlm and munge (Debian) if they are missing, and snakemake.
#
#   scripts/workflow/test_slurm.sh [SUITE]          default: simulated-quick
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/workflow/test_slurm.sh; exit 0 ;;
  -*) echo "test_slurm.sh: '$1' is unknown; expected nothing, or a suite." >&2; exit 2 ;;
esac
suite=${1:-simulated-quick}
program=build/release/raymoval

if [[ $(id -u) -ne 0 ]]; then
  echo "test_slurm.sh: has to be run as root." >&2
  exit 2
fi
[[ -x $program ]] || { echo "test_slurm.sh: build $program first (scripts/reproduce.sh)." >&2; exit 2; }
missing=()
for package in snakemake slurm-wlm munge; do
  dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed ||
    missing+=("$package")
done
if [[ ${#missing[@]} -gt 0 ]]; then
  apt-get install --yes --no-install-recommends "${missing[@]}" ||
    { apt-get update && apt-get install --yes --no-install-recommends "${missing[@]}"; }
fi

# Everything of this Slurm lives here; one that runs already is not touched.
work=$(mktemp -d)
chmod 755 "$work"
daemons=()
stop() {
  for ((i = ${#daemons[@]} - 1; i >= 0; --i)); do kill "${daemons[i]}" 2>/dev/null || true; done
  for pid in "${daemons[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap stop EXIT

# free_port: a port that nobody listens on.
free_port() {
  local port
  for port in $(shuf -i 20000-39999 -n 50); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
}

mkdir "$work/munge" "$work/spool" "$work/state"
dd if=/dev/urandom of="$work/munge/key" bs=1 count=1024 status=none
chmod 400 "$work/munge/key"
chmod 755 "$work/munge"
munged --foreground --key-file "$work/munge/key" --socket "$work/munge/socket" \
  --pid-file "$work/munge/pid" --seed-file "$work/munge/seed" --log-file "$work/munge/log" \
  >"$work/munged.txt" 2>&1 &
daemons+=($!)

host=$(hostname -s)
cat >"$work/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=2
ReturnToService=2
MaxJobCount=1000
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(awk '/MemTotal/ { print int($2 / 1024 * 0.8) }' /proc/meminfo) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
printf 'CgroupPlugin=cgroup/v1\nConstrainCores=no\n' >"$work/cgroup.conf"
export SLURM_CONF=$work/slurm.conf
for _ in $(seq 50); do [[ -S $work/munge/socket ]] && break; sleep 0.1; done
slurmctld -D >"$work/slurmctld.txt" 2>&1 &
daemons+=($!)
slurmd -D >"$work/slurmd.txt" 2>&1 &
daemons+=($!)
for _ in $(seq 100); do sinfo --noheader --format=%t 2>/dev/null | grep -qE 'idle|mix' && break; sleep 0.3; done
if ! sinfo --noheader --format=%t 2>/dev/null | grep -qE 'idle|mix'; then
  echo "test_slurm.sh: the node does not come up:" >&2
  tail -n 20 "$work"/*.txt "$work"/*.log >&2 || true
  exit 1
fi
echo "test_slurm.sh: Slurm $(sinfo --version | cut -d' ' -f2) is up with $(nproc) cores"

snakemake -s scripts/workflow/Snakefile --profile scripts/workflow/slurm --quiet rules \
  --config "suite=$suite" "out=$work/slurm" mem_mb=2000 minutes=60 >"$work/snakemake.txt" 2>&1 ||
  { cat "$work/snakemake.txt" >&2; tail -n 30 "$work"/*.log >&2; exit 1; }
jobs=$(grep -c 'Submitted job' "$work/snakemake.txt" || true)
$program run "$suite" --out "$work/plain" --quiet >"$work/plain.txt"

# Counts, rates, data, parameters: everything but times.
$program compare "$work/slurm" "$work/plain"
cut -d, -f1-15 "$work/slurm/results.csv" >"$work/slurm.csv"
cut -d, -f1-15 "$work/plain/results.csv" >"$work/plain.csv"
diff "$work/slurm.csv" "$work/plain.csv"
echo "test_slurm.sh: $jobs jobs of Slurm gave the results of a plain run of $suite."
