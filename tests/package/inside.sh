#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The part of package.sh that runs inside the clean root, where the package lies in three versions in /.
# usage: inside.sh VERSION
set -euo pipefail
version=$1
cd /
export DEBIAN_FRONTEND=noninteractive
checks=0

fail() {
  echo "package: $*" >&2
  exit 1
}
# holds WORDS TEST...: the command succeeds
holds() {
  local words=$1
  shift
  "$@" || fail "$words"
  checks=$((checks + 1))
}
fails() { ! "$@"; }
is() { [[ $(stat -c '%U:%G %a' "$2") == "$1" ]] || { stat -c '%n is %U:%G %a' "$2"; return 1; }; }
run_dpkg() { dpkg "$@" >/tmp/dpkg.log 2>&1 || { cat /tmp/dpkg.log >&2; fail "dpkg $*"; }; }
# Everything but what dpkg, ldconfig, systemctl and this test write themselves.
everything() {
  find / -xdev \( -path /proc -o -path /dev -o -path /tmp -o -path /var/lib/dpkg -o -path /var/log/dpkg.log \
    -o -path /run/systemd -o -path /var/cache/ldconfig -o -name '.pwd.lock' -o -path '/etc/*-' \) -prune -o -printf '%y %m %u:%g %p\n' | sort
}
users() { sort /etc/passwd /etc/group /etc/shadow /etc/gshadow; }
is_enabled() { [[ -L /etc/systemd/system/multi-user.target.wants/deltamap.service ]]; }

touch /etc/.pwd.lock
everything >/tmp/files.before
users >/tmp/users.before

# --- install
run_dpkg -i "/deltamap_$version.deb"
for program in /usr/bin/deltamapd /usr/bin/deltamap /usr/libexec/deltamap/restart-delay; do holds "$program" is 'root:root 755' $program; done
for file in /lib/systemd/system/deltamap.service /lib/udev/rules.d/60-deltamap.rules /usr/lib/sysusers.d/deltamap.conf \
  /usr/lib/tmpfiles.d/deltamap.conf /etc/deltamap/deltamap.yaml /usr/share/man/man8/deltamapd.8.gz \
  /usr/share/man/man1/deltamap.1.gz /usr/share/man/man5/deltamap.yaml.5.gz /usr/share/bash-completion/completions/deltamap \
  /usr/share/bash-completion/completions/deltamapd \
  /usr/share/deltamap/default.yaml /usr/share/deltamap/deltamap.schema.json /usr/share/deltamap/simulation.yaml /usr/share/deltamap/scenarios/hall.yaml \
  /usr/share/doc/deltamap/copyright /usr/share/doc/deltamap/changelog.gz /usr/share/doc/deltamap/README.md \
  /usr/share/doc/deltamap/docs/operating.md /usr/share/doc/deltamap/docs/operating/why-it-stands.md /usr/share/doc/deltamap/examples/deltamap-page.socket \
  /usr/share/doc/deltamap/examples/deltamap-page.conf; do
  holds "$file" is 'root:root 644' "$file"
done
holds "Wireshark finds both protocols" is 'root:root 644' /usr/lib/*/wireshark/plugins/deltamap.lua
for folder in /var/lib/deltamap /var/lib/deltamap/maps /var/lib/deltamap/recordings /var/lib/deltamap/incidents; do
  holds "$folder" is 'deltamap:deltamap 750' "$folder"
done
holds "the configuration is a conffile" grep -q '^ /etc/deltamap/deltamap.yaml ' <(dpkg-query -W -f='${Conffiles}\n' deltamap)
holds "the only conffile" test "$(dpkg-query -W -f='${Conffiles}\n' deltamap | grep -c .)" = 1
holds "the files are as packed" dpkg --verify deltamap
holds "udev knows a port's ID_PATH where the rule looks at it" \
  awk '/IMPORT{builtin}="path_id"/ { known = 1 } /ENV{ID_PATH}==/ { exit !known }' /lib/udev/rules.d/60-deltamap.rules
holds "user deltamap may open serial ports" grep -qw dialout <(id -nG deltamap)
holds "user deltamap has no password" grep -q '^deltamap:!' /etc/shadow
holds "user deltamap has no shell" grep -q '^deltamap:.*nologin$' /etc/passwd
holds "not enabled" fails is_enabled
holds "nothing else is enabled" fails grep -rq deltamap /etc/systemd/system
holds "no daemon runs" fails pidof deltamapd

# --- what was installed works, outside the repository
mkdir /tmp/elsewhere && cd /tmp/elsewhere
holds "--version of the daemon" grep -q "^deltamapd $version (commit [0-9a-f]" <(deltamapd --version)
holds "--version of the tool" grep -q "^deltamap $version (commit [0-9a-f]" <(deltamap --version)
holds "the settings name their schema" grep -qx '# yaml-language-server: $schema=/usr/share/deltamap/deltamap.schema.json' /etc/deltamap/deltamap.yaml
holds "the schema is the program's" cmp -s /usr/share/deltamap/deltamap.schema.json <(deltamapd --print-schema)
holds "the motors stay off" grep -qx '  mode: off *#.*' <(deltamapd --config /etc/deltamap/deltamap.yaml --print-config)
code=0
deltamapd --config /etc/deltamap/deltamap.yaml --check-config >check.log || code=$?
holds "without a map there is no start" test "$code" = 2
holds "it says which map is missing" grep -q '^error *map */var/lib/deltamap/maps/site.yaml: ' check.log
holds "a scenario by its name" runuser -u deltamap -- deltamap sim --world hall --write-map /var/lib/deltamap/maps/site.yaml
code=0
deltamap sim --world hill --write-map x.yaml 2>sim.log || code=$?
holds "an unknown scenario is refused" test "$code" = 1
holds "and the known ones are named" grep -q "^deltamap: hill: .*/usr/share/deltamap/scenarios has .*demo.*hall" sim.log
runuser -u deltamap -- deltamapd --config /etc/deltamap/deltamap.yaml --check-config >check.log || fail "$(cat check.log)"
holds "drive is off" grep -q '^ok *drive *off: it never moves the robot' check.log
holds "the unit makes the folder of the socket" grep -q '^ok *control .*the unit makes /run/deltamap' check.log
holds "devices are all that is missing" fails grep -qE '^warning *[^rl ]' check.log
# As the unit does at each start.
install -d -o deltamap -g deltamap -m 755 /run/deltamap
runuser -u deltamap -- deltamapd --config /etc/deltamap/deltamap.yaml 2>daemon.log &
for _ in $(seq 100); do [[ -S /run/deltamap/ctl.sock ]] && break; sleep 0.1; done
holds "ctl status" deltamap ctl status >status.log
holds "ctl drive cannot start it" fails deltamap ctl drive wander >/dev/null 2>&1
holds "stops in order" kill "$(pidof deltamapd)"
wait %1 || fail "$(cat daemon.log)"
holds "the newest map is there for others" test -s /var/lib/deltamap/map.yaml -a -s /var/lib/deltamap/map.pgm
rm -rf /run/deltamap

# --- unit, manual, completion
holds "the unit is sound" systemd-analyze verify --man=no --recursive-errors=no /lib/systemd/system/deltamap.service
systemd-analyze security --offline=true --no-pager --threshold=15 /lib/systemd/system/deltamap.service >exposure.log || fail "exposure: $(tail -1 exposure.log)"
tail -1 exposure.log
for page in man8/deltamapd.8 man1/deltamap.1 man5/deltamap.yaml.5; do
  holds "$page names what it is about" grep -q '^\.SH NAME' <(zcat "/usr/share/man/$page.gz")
done
keys=$(deltamapd --config /etc/deltamap/deltamap.yaml --print-config | grep -c '^ *[a-z_0-9]*: .*# ')
holds "every key is in the manual" test "$(zcat /usr/share/man/man5/deltamap.yaml.5.gz | grep -c '^Default: ')" = "$keys"
completed() {  # PROGRAM WORDS...: the proposals, or <files> where bash completes files
  bash -c 'compopt() { [[ "$*" != "-o default" ]] || COMPREPLY=("<files>"); }
    source "/usr/share/bash-completion/completions/$1"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_$1"; echo "${COMPREPLY[*]}"' completed "$@"
}
holds "completes a command" test "$(completed deltamap repl)" = replay
holds "completes below a command" test "$(completed deltamap ctl pa)" = pause
holds "completes behind an argument" test "$(completed deltamap map history store.sqlite roll)" = rollback
holds "completes an option" test "$(completed deltamap sim --wor)" = --world
holds "completes the words of an argument" test "$(completed deltamap ctl --socket /run/x drive '')" = "off wander"
holds "completes the words of an option" test "$(completed deltamap map merge a.yaml b.yaml --method = g)" = global
holds "completes a file that a command takes" test "$(completed deltamap replay '')" = "<files>"
holds "completes a file that an option takes" test "$(completed deltamap replay x.pcapng --map = '')" = "<files>"
holds "proposes no file for a number" test "$(completed deltamap replay --seed '')" = ""
holds "completes the daemon's options" test "$(completed deltamapd --check)" = --check-config
holds "completes the daemon's settings file" test "$(completed deltamapd --config '')" = "<files>"

# --- upgrade
runuser -u deltamap -- touch /var/lib/deltamap/map_store.sqlite
holds "an operator enables it" systemctl --quiet enable deltamap.service
run_dpkg -i "/deltamap_$version+1.deb"
holds "a configuration that nobody edited is renewed" grep -q "^# delivered with $version+1" /etc/deltamap/deltamap.yaml
sed -i 's/laser:/laser: # ours/' /etc/deltamap/deltamap.yaml
run_dpkg --force-confold -i "/deltamap_$version+2.deb"
holds "an edited configuration stays" grep -q '^laser: # ours' /etc/deltamap/deltamap.yaml
holds "the new one lies beside it" grep -q "^# delivered with $version+2" /etc/deltamap/deltamap.yaml.dpkg-dist
holds "maps stay" test -f /var/lib/deltamap/maps/site.pgm -a -f /var/lib/deltamap/map_store.sqlite
holds "it stays enabled" is_enabled
holds "the new version is there" test "$(dpkg-query -W -f='${Version}' deltamap)" = "$version+2"

# --- remove
run_dpkg -r deltamap
holds "the programs are gone" fails test -e /usr/bin/deltamapd -o -e /usr/bin/deltamap -o -e /lib/systemd/system/deltamap.service -o -e /usr/libexec/deltamap
holds "configuration, maps and their owner stay" test -f /etc/deltamap/deltamap.yaml -a -f /var/lib/deltamap/maps/site.pgm
holds "the store stays its owner's" is 'deltamap:deltamap 644' /var/lib/deltamap/map_store.sqlite
run_dpkg --force-confold -i "/deltamap_$version+2.deb"
holds "back again, with the edited configuration" grep -q '^laser: # ours' /etc/deltamap/deltamap.yaml
holds "and with its maps" test -f /var/lib/deltamap/maps/site.pgm -a -f /var/lib/deltamap/map_store.sqlite

# --- purge
run_dpkg -P deltamap
cd / && everything >/tmp/files.after
users >/tmp/users.after
holds "no file is left" diff /tmp/files.before /tmp/files.after
holds "no user is left" diff /tmp/users.before /tmp/users.after
run_dpkg -i "/deltamap_$version.deb"
userdel deltamap && rm -r /var/lib/deltamap
run_dpkg -P deltamap
everything >/tmp/files.after
holds "a purge after user and folder were removed by hand" diff /tmp/files.before /tmp/files.after
run_dpkg -i "/deltamap_$version.deb"
usermod --append --groups deltamap games
run_dpkg -P deltamap
users >/tmp/users.after
holds "a purge where another user is in the group" diff /tmp/users.before /tmp/users.after
run_dpkg -i "/deltamap_$version.deb"
setpriv --reuid deltamap --regid deltamap --clear-groups sleep 60 &
until [[ $(stat -c %U /proc/$!) == deltamap ]]; do sleep 0.1; done
run_dpkg -P deltamap
holds "a purge while a process of the user runs says so in one line" test "$(grep -c '^deltamap: the user deltamap stays: ' /tmp/dpkg.log)" = 1
holds "and ends" fails dpkg-query -W deltamap >/dev/null 2>&1
kill $!
echo "package: $checks checks"
