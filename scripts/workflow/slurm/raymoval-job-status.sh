#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Reports the state of a Slurm job to Snakemake: running, success or failed. Usage: raymoval-job-status.sh JOB
state=$(scontrol show job --oneliner "$1" 2>/dev/null | grep -oE 'JobState=[A-Z_]+')
if [[ -z $state ]]; then
  # Slurm removes a job some minutes after its end; the accounting, if there is one, keeps it.
  state=JobState=$(sacct --noheader --parsable2 --allocations --format=State -j "$1" 2>/dev/null | head -1)
fi
case ${state#JobState=} in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | PREEMPTED) echo running ;;
  *) echo failed ;;
esac
