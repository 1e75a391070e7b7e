#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tells Snakemake how a job of Slurm is: running, success or failed. Usage: raymoval-job-status.sh JOB
state=$(scontrol show job --oneliner "$1" 2>/dev/null | grep -oE 'JobState=[A-Z_]+')
if [[ -z $state ]]; then
  # Slurm forgets a job some minutes after its end; the accounting, where there is one, does not.
  state=JobState=$(sacct --noheader --parsable2 --allocations --format=State -j "$1" 2>/dev/null | head -1)
fi
case ${state#JobState=} in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | PREEMPTED) echo running ;;
  *) echo failed ;;
esac
