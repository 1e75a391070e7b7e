#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The end of the program by a signal to it or to its child, or by SIGKILL; the remains, and how long
# they stay.
# Usage: signals_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
mkdir temporary cache
export TMPDIR=$work/temporary RAYMOVAL_CACHE=$work/cache

# begin ARGUMENTS...: the program in the background; its number is $process.
begin() {
  "$raymoval" "$@" >out.txt 2>err.txt &
  process=$!
}
# ends CODE NAME: the exit code of the started program.
ends() {
  local got
  wait $process 2>/dev/null
  got=$?
  cp err.txt said.txt
  holds "$2 ends with $1, not $got" test $got -eq "$1"
}
# wait_for_name PATTERN: until a file has such a name, or the program is gone.
wait_for_name() {
  until compgen -G "$1" >/dev/null || ! kill -0 $process 2>/dev/null; do sleep 0.02; done
  holds "$1 came" compgen -G "$1"
}
child_of() { pgrep -P "$1" | head -1; }
wait_for_child() {
  until child=$(child_of $process) && [[ -n $child ]] || ! kill -0 $process 2>/dev/null; do
    sleep 0.02
  done
}
# parts: files and folders that are not finished.
parts() { find . -name '*.part' -o -name '*.lock' -o -name 'raymoval-external*'; }
nothing_left() {
  parts >left.txt
  holds "$1 leaves nothing unfinished: $(tr '\n' ' ' <left.txt)" test ! -s left.txt
}
# sleepers: the processes that sleep for $nap seconds, with any environment.
nap=3000.$$
sleepers() { pgrep -fx "sleep $nap"; }
no_sleepers() {
  for _ in $(seq 1500); do
    sleepers >/dev/null || break
    sleep 0.02
  done
  holds "$1 leaves no process: $(sleepers | tr '\n' ' ')" test -z "$(sleepers)"
  for left in $(sleepers); do kill -KILL "$left"; done
}

slow=(--method comb --set comb.milliseconds=1000 --quiet)
clean=(clean street --frames 0:2 "${slow[@]}" -o map.pcd --dynamic removed.pcd --labels labels)
run=(run --sequence street --frames 0:2 "${slow[@]}" --only '*/comb*' --out run)
for signal in INT TERM HUP; do
  code=$((128 + $(kill -l $signal)))
  begin "${clean[@]}"
  wait_for_name 'map.pcd.*.part'
  kill -$signal $process
  ends $code "clean after SIG$signal"
  holds "it says so" grep -q cancelled said.txt
  nothing_left "clean after SIG$signal"
  holds "and no output" test ! -e map.pcd -a ! -e removed.pcd -a ! -e labels
  begin "${run[@]}"
  wait_for_child
  kill -$signal $process
  ends $code "run after SIG$signal"
  holds "it says how to go on" grep -q "the same command runs the rest" said.txt
  nothing_left "run after SIG$signal"
  begin simulate town -o drive --quiet
  wait_for_name 'drive.*.part'
  kill -$signal $process
  ends $code "simulate after SIG$signal"
  nothing_left "simulate after SIG$signal"
  holds "and no sequence" test ! -e drive
done

# A second signal ends the program at once: here a method never checks for cancellation.
begin run --sequence street --frames 0:9 "${slow[@]}" --only '*/comb*' --in-process --out alone
wait_for_name alone/cells/street/comb-default_
kill -TERM $process
sleep 1  # Of two signals that come at once the first number would count.
holds "the first signal is noted" kill -0 $process
kill -INT $process
ends 130 "a run after a second signal"
holds "its lock is left" test -s alone/run.lock
expect 0 "" run --sequence street --frames 0:2 --method noop --quiet --overwrite --out alone
holds "and taken over" test ! -e alone/run.lock

# The same for all processes, as a system does it that shuts down: no cell has failed.
begin "${run[@]}"
wait_for_child
kill -TERM "$child" $process
ends 143 "a run whose child was ended, too"
holds "no cell has failed" test ! -e run/cells/street/comb-default_/cell.json
begin "${clean[@]}"
wait_for_name 'map.pcd.*.part'
kill -TERM "$(child_of $process)" $process
ends 143 "clean whose child was ended, too"
nothing_left "it"
# A signal to the child alone is a failure: the program itself was not cancelled.
begin "${clean[@]}"
wait_for_name 'map.pcd.*.part'
kill -TERM "$(child_of $process)"
ends 2 "clean whose child was ended"
holds "it says by what" grep -q "ended from outside by signal 15" said.txt
nothing_left "it"

# A program that is started with an ignored signal must continue.
(trap '' HUP TERM; exec "$raymoval" run --sequence street --frames 0:2 --method comb --quiet \
  --only '*/comb*' --set comb.milliseconds=100 --out nohup >out.txt 2>err.txt) &
process=$!
wait_for_name nohup/cells
kill -HUP $process
kill -TERM $process
ends 0 "a run with nohup"

# Killed: the next command that uses the place removes what was left there.
begin "${clean[@]}"
wait_for_name 'map.pcd.*.part'
wait_for_name 'labels.*.part'
kill -KILL $process
ends 137 "clean after SIGKILL"
holds "unfinished outputs are left" compgen -G '*.part'
expect 0 "" clean street --frames 0:2 --method noop --quiet -o map.pcd --dynamic removed.pcd \
  --labels labels
nothing_left "the next clean"
# abandoned_recording: what a killed reader of a packed recording leaves in TMPDIR.
abandoned_recording() {
  mkdir "temporary/raymoval-recording.raymoval-$(head -c 8 /proc/sys/kernel/random/boot_id)0123456789abcdef.part"
}
abandoned_recording
expect 0 "" clean street --frames 0:2 --method noop --quiet -o after.pcd
nothing_left "clean after a killed reader of a recording"
abandoned_recording
expect 0 "" run --sequence street --frames 0:2 --method comb --quiet --only '*/comb*' --out after
nothing_left "a run after a killed reader of a recording"
begin simulate town -o drive --quiet
wait_for_name 'drive.*.part'
kill -KILL $process
ends 137 "simulate after SIGKILL"
holds "an unfinished sequence is left" compgen -G 'drive.*.part'
expect 0 "" simulate town --scans 1 --sensor vlp16 -o drive --quiet
nothing_left "the next simulation"
begin run --sequence town --method noop --quiet --out town
wait_for_name 'cache/simulated/*.part'
kill -KILL $process
ends 137 "a run that simulates after SIGKILL"
holds "an unfinished scene is left" compgen -G 'cache/simulated/*.part'
holds "and a lock" compgen -G 'cache/simulated/*.lock'
expect 0 "" run --sequence town:scans=1 --method noop --quiet --out other
nothing_left "the next scene"

# An external program that leaves everything that can be left: parent, session, environment.
mkdir method
cat >method/manifest.json <<'JSON'
{ "name": "leaver", "sentence": "Leaves.", "source": "none", "version": "1", "online": false,
  "command": ["sh", "{here}/leave.sh"], "files": ["leave.sh"] }
JSON
external=(run --sequence street --frames 0:2 --method external:method/manifest.json --quiet
  --only '*/leaver*')
daemon="(env -i setsid sh -c 'sleep $nap & sleep $nap & wait' >/dev/null 2>&1 &)"
# until_both: until both of them sleep.
until_both="while [ \"\$(pgrep -cfx 'sleep $nap')\" -lt 2 ]; do sleep 0.02; done"
echo "$daemon; $until_both; exit 0" >method/leave.sh
expect 1 "predictions/000000.label: missing" "${external[@]}" --out left
no_sleepers "a program that leaves a daemon"
nothing_left "it"
echo "$daemon; $until_both; kill -KILL \$PPID; sleep $nap" >method/leave.sh
expect 1 "killed from outside" "${external[@]}" --out left
no_sleepers "a method whose process is killed"
nothing_left "it"
echo "$daemon; $until_both; : >'$work/ready'; sleep $nap" >method/leave.sh
# kill_with_program VICTIM: kills a run, or clean, while its program sleeps.
kill_with_program() {
  rm -f ready
  if [[ $1 == run ]]; then
    begin "${external[@]}" --out left
  else
    begin clean street --frames 0:2 --method external:method/manifest.json --quiet -o left.pcd
  fi
  wait_for_name ready
  kill -KILL $process
  ends 137 "$1 after SIGKILL"
  no_sleepers "$1 that was killed"
}
for victim in run clean; do
  # The method's process sometimes gets to remove the folder before it is ended, too. Then there is
  # nothing that the next run could find.
  for attempt in 1 2 3 4 5; do
    kill_with_program $victim
    ! compgen -G 'temporary/*' >/dev/null || break
  done
  holds "its working folder is left, in $attempt tries" compgen -G 'temporary/*'
done
# A second signal ends a run while it ends its method's processes. Among many others it takes some time to
# find them.
crowd=()
for _ in $(seq 800); do
  sleep 600 &
  crowd+=($!)
done
for delay in 0.01 0.015 0.02 0.03 0.04 0.06; do
  rm -f ready
  begin "${external[@]}" --out left
  wait_for_name ready
  kill -INT $process
  sleep $delay
  kill -INT $process 2>/dev/null
  wait $process 2>/dev/null
  no_sleepers "a run that was interrupted twice, $delay s apart"
done
kill "${crowd[@]}"
wait "${crowd[@]}" 2>/dev/null
echo "exit 3" >method/leave.sh
expect 1 "exit code 3" "${external[@]}" --out left
expect 1 "" clean street --frames 0:2 --method external:method/manifest.json --quiet -o left.pcd
nothing_left "the next run and clean"

# All descendants count: 80 MiB of zeros in each of a program's orphans, in the program's own time.
echo "(env -i setsid sh -c 'head -c 200000000 /dev/zero | tail -c 160000000 | sleep $nap' \
>/dev/null 2>&1 &); sleep $nap" >method/leave.sh
expect 1 "used more than 120 MiB" "${external[@]}" --memory-limit 120 --out left
no_sleepers "a program that exceeds its memory"
finish signals
