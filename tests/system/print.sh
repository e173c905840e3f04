#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What the daemon prints of its settings: the documents without a settings file, and of a bad file every mistake, by line,
# on standard error, while --check-config looks at the rest. usage: print.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"

same() { cmp -s "$1" "$2" || fail "$1 is not what the program prints"; }
"$bin/deltamapd" --print-schema >"$out/schema" || fail "--print-schema ends with $?"
same config/deltamap.schema.json "$out/schema"
"$bin/deltamapd" --print-configuration-md >"$out/page" || fail "--print-configuration-md ends with $?"
same docs/configuration.md "$out/page"
"$bin/deltamapd" --config /dev/null --print-config >"$out/yaml" || fail "--print-config ends with $?"
same config/default.yaml "$out/yaml"
"$bin/deltamapd" --config "$out/yaml" --print-config | cmp -s "$out/yaml" - || fail "what is printed does not read back"

for what in --print-schema --print-configuration-md "--config $out/yaml --print-config" "--config $out/yaml --check-config"; do
  code=0
  "$bin/deltamapd" $what >/dev/full 2>"$out/err" || code=$?
  [[ $code == 1 ]] && grep -q 'standard output: cannot be written' "$out/err" || fail "$what on a full disk ends with $code"
done

code=0
"$bin/deltamapd" --print-config >/dev/null 2>"$out/err" || code=$?
[[ $code == 2 ]] && grep -q -- '--config is required' "$out/err" || fail "a missing --config is not told"

printf 'robot:\n\tport: a\n  sonar: maybe\nlaser: {prot: /dev/x, port: /nowhere/laser}\nnaviation: {mode: wander}\n' >"$out/bad.yaml"
cat >"$out/wanted" <<END
deltamapd: $out/bad.yaml:2:1: a tab in the indentation: YAML wants blanks
deltamapd: $out/bad.yaml:3:10: robot.sonar: needs true or false, not 'maybe'
deltamapd: $out/bad.yaml:4:9: laser.prot: unknown key (nearest key laser.port)
deltamapd: $out/bad.yaml:5:1: naviation: unknown section (nearest section navigation)
deltamapd: --set seed=x: seed: needs a whole number (from 0), not 'x'
END
for mode in "" --check-config --print-config; do
  code=0
  timeout -s KILL 120 "$bin/deltamapd" --config "$out/bad.yaml" --set seed=x $mode >"$out/said" 2>"$out/err" || code=$?
  [[ $code == 2 ]] || fail "a bad file with '$mode' ends with $code"
  diff "$out/wanted" "$out/err" >&2 || fail "'$mode' tells other mistakes"
done
printf 'laser: {port: /nowhere/laser}\nrobot: {sonar: maybe}\n' >"$out/bad.yaml"
"$bin/deltamapd" --config "$out/bad.yaml" --check-config >"$out/said" 2>/dev/null && fail "a bad file is good"
grep -q "^error    settings  $out/bad.yaml: 1 mistake: see standard error" "$out/said" || fail "the mistakes are not counted"
grep -q '^warning  laser     /nowhere/laser is missing' "$out/said" || fail "a port is not looked at beside a mistake"
echo "print: 3 documents, 1 bad file in 3 ways"
