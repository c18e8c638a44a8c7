# Runs PAGE_ROOM/page.sh in PAGE_ROOM/tandem: its home is PAGE_ROOM, its network its own where the system permits that, for pages use
# the default ports.
cd "$PAGE_ROOM/tandem" || exit 1
export HOME=$PAGE_ROOM TERM=xterm PATH=$PAGE_ROOM/tandem:$PATH
unset TANDEM_LAUNCHER TANDEM_PRESET CI
apart=()
if unshare -n true 2>/dev/null; then
  apart=(unshare -n sh -c 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; exec "$@"' sh)
fi
exec timeout 300 "${apart[@]}" bash "$PAGE_ROOM/page.sh" >"$PAGE_ROOM/log" 2>&1 </dev/null
