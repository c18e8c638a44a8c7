# What a page's script begins with: every command is tried, and those that fail are named in PAGE_ROOM/failed.
set -o pipefail -E
export PAGE_SECONDS
place=
at() {
  place=$1
  printf '\n== %s\n' "$1"
}
trap 'echo "$place: exit code $?: $BASH_COMMAND" >>"$PAGE_ROOM/failed"' ERR

# leave NAME: runs the function of this name beside what follows; returns when it has begun: it has said something, and nothing more for
# 0.3 s, or two seconds have passed.
leave() {
  local log=$PAGE_ROOM/$1.log i size=0 quiet=0
  PAGE_LEFT=1 "$1" >"$log" 2>&1 &
  for ((i = 0; i < 20 && quiet < 3; ++i)); do
    sleep 0.1
    quiet=$((quiet + 1))
    [[ -s $log && $(stat -c %s "$log") -eq $size ]] || quiet=0
    size=$(stat -c %s "$log")
  done
  sed -n 's/.*token=\([A-Za-z0-9_-]*\).*/\1/p' "$log" | head -n 1 >"$PAGE_ROOM/token"
  kill -0 $! # it is still there
}

finish() {
  trap - ERR
  for log in "$PAGE_ROOM"/left*.log; do
    [[ ! -e $log ]] || { printf '\n== %s\n' "${log##*/}" && cat "$log"; }
  done
  [[ ! -s $PAGE_ROOM/failed ]]
}
