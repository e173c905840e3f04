#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the manual pages and the bash completions from what the programs say of themselves: --help of both, and of
every subcommand; --print-config for the settings. What no program prints (files, exit codes, signals) stands here.
usage: manual.py FOLDER-OF-PROGRAMS OUT-FOLDER"""
import dataclasses, os, pathlib, re, subprocess, sys, tempfile, time

NAME_WIDTH = 30  # column at which CLI11 begins an explanation


@dataclasses.dataclass
class Help:
    path: list  # ["deltamap", "map", "history"]
    about: str
    usage: str
    sections: dict  # "Options" -> [(name, explanation)]
    below: list = dataclasses.field(default_factory=list)


def told(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        sys.exit("manual.py: %s: exit code %d: %s" % (" ".join(map(str, words)), done.returncode, done.stderr.strip()))
    return done.stdout


def entries(lines):
    """[(name, explanation)]: a name of its own line has its explanation on the next."""
    found = []
    for line in lines:
        if line.startswith(" " * NAME_WIDTH):
            found[-1][1] += line.strip() + " "
        else:
            name, gap, explanation = line.strip().partition("  ")
            if not gap and len(name) > NAME_WIDTH - 3:  # a long name and its explanation, one blank apart
                match = re.match(r"(.*?(?:\]|REQUIRED|\.\.\.)) (.*)", name)
                name, explanation = match.groups() if match else (name, "")
            found.append([name.strip(), explanation.strip() + " "])
    return [(name, " ".join(explanation.split())) for name, explanation in found]


def read_help(program, path, arguments):
    lines = told([program, *arguments, "--help"]).splitlines()
    usage = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    sections, title = {}, None
    for line in lines[usage + 1:]:
        if line and not line.startswith(" ") and line.endswith(":"):
            title = line[:-1]
            sections[title] = []
        elif line.strip():
            sections[title].append(line)
    help = Help(path, " ".join(lines[:usage]).strip(), lines[usage].removeprefix("Usage: "),
                {title: entries(body) for title, body in sections.items()})
    if len(path) == 1:
        help.about = help.about.removeprefix(path[0] + ": ")
    place_holders = ["X"] * len(help.sections.get("Positionals", []))
    if "Subcommands" in help.sections:
        help.below = [read_help(program, path + [name], arguments + place_holders + [name])
                      for name, _ in help.sections["Subcommands"]]
    return help


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("°", "\\(de").replace("…", "...").replace("Δ", "\\(*D")
    for letter, name in (("α", "*a"), ("δ", "*d"), ("ε", "*e"), ("λ", "*l"), ("σ", "*s"), ("√", "sr")):
        text = text.replace(letter, "\\(" + name)
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def option_entries(help, title):
    body = ""
    for name, explanation in help.sections.get(title, []):
        required = " (required)" if "REQUIRED" in name else ""
        excluded = re.search(r"Excludes: (\S+)", name)
        if excluded:
            required = " (not with %s)" % excluded.group(1)
        name = re.sub(r"\s*(REQUIRED|Excludes: \S+|Needs: \S+)", "", name)
        body += ".TP\n.B %s\n%s\n" % (roff(name.replace(",", ", ")), roff(explanation + required))
    return body


def command_text(help):
    text = ".SS %s\n%s\n.br\n.B %s\n" % (roff(" ".join(help.path[1:])), roff(help.about[:1].upper() + help.about[1:] + "."),
                                        roff(help.usage))
    for title in ("Positionals", "Options"):
        shown = [one for one in help.sections.get(title, []) if not one[0].startswith("-h,")]
        text += option_entries(dataclasses.replace(help, sections={title: shown}), title)
    return text + "".join(command_text(one) for one in help.below)


def page(name, section, title, day, version, *parts):
    head = '.\\" Written by packaging/manual.py\n.TH %s %s %s "deltamap %s" "deltamap"\n' % (name, section, day, version)
    return head + ".SH NAME\n%s \\- %s\n" % (name, roff(title)) + "".join(".SH %s\n%s\n" % part for part in parts)


def items(*pairs):
    return "".join(".TP\n.B %s\n%s\n" % (roff(name), roff(text)) for name, text in pairs)


EXITS = {
    "deltamapd": items(("0", "ended by a signal, or looked at and found good"), ("1", "could not, or a stage has failed"),
                       ("2", "wrong usage, wrong settings, or what only a person can mend: the unit does not start it again")),
    "deltamap": items(("0", "done"), ("1", "could not; one line on standard error says why"), ("2", "wrong usage")),
}
PLACES = items(("/etc/deltamap/deltamap.yaml", "settings: see deltamap.yaml(5)"),
               ("/usr/share/deltamap/deltamap.schema.json", "JSON schema of the settings, for editors"),
               ("/var/lib/deltamap", "maps, their revisions and what is kept for the next start"),
               ("/run/deltamap/ctl.sock", "where deltamap ctl finds the daemon"))
SIGNALS = items(("SIGTERM, SIGINT, SIGQUIT", "stop the robot, write what is to be kept, end"),
                ("SIGHUP", "without a terminal: read the settings again, as deltamap ctl reload does; the terminal gone: as SIGTERM"))


def daemon_page(help, day, version):
    return page("deltamapd", 8, help.about, day, version,
                ("SYNOPSIS", ".B %s" % roff(help.usage)),
                ("DESCRIPTION", roff("The daemon owns the serial ports of a Pioneer robot and its SICK LMS200 laser, keeps the robot "
                                     "localized, and rewrites its occupancy grid where the world has changed. It never enables the "
                                     "motors unless navigation.mode allows it and a person has said so.")),
                ("OPTIONS", option_entries(help, "Options")), ("SIGNALS", SIGNALS), ("FILES", PLACES),
                ("EXIT STATUS", EXITS["deltamapd"]),
                ("SEE ALSO", ".BR deltamap (1),\n.BR deltamap.yaml (5),\n.BR systemctl (1)"))


def tool_page(help, day, version):
    places = items(("/usr/share/deltamap/scenarios", "worlds that deltamap sim plays by name"))
    return page("deltamap", 1, "tool of the daemon deltamapd: talk to it, replay, compare maps, simulate", day, version,
                ("SYNOPSIS", ".B %s" % roff(help.usage)), ("OPTIONS", option_entries(help, "Options")),
                ("COMMANDS", "".join(command_text(one) for one in help.below)), ("FILES", places + PLACES),
                ("EXIT STATUS", EXITS["deltamap"]), ("SEE ALSO", ".BR deltamapd (8),\n.BR deltamap.yaml (5)"))


def settings_page(listing, day, version):
    keys, section = "", []
    for line in listing.splitlines():
        match = re.match(r"( *)([a-z0-9_]+):\s*(.*?)\s*(?:# (.*))?$", line)
        if not match or line.startswith("#"):
            continue
        indent, name, value, meaning = match.groups()
        section = section[:len(indent) // 2] + [name]
        if meaning is not None:
            keys += ".TP\n.B %s\n%s\n.br\nDefault: %s\n" % (roff(".".join(section)), roff(meaning), roff(value or '""'))
    return page("deltamap.yaml", 5, "settings of deltamapd", day, version,
                ("DESCRIPTION", roff("One YAML file holds every setting; what it leaves out is as delivered. Nested keys are written below "
                                     "each other, or for one run as --set laser.port=/dev/ttyUSB1. An unknown key, a value of the wrong "
                                     "type or outside its range ends the start; all mistakes of a file are told at once, each with file, line "
                                     "and column. A running daemon reads the file again with deltamap ctl reload.")),
                ("KEYS", roff("Unit and range stand before the colon, the meaning behind it, the symbol of paper or textbook in parentheses.") + "\n" + keys),
                ("FILES", PLACES), ("SEE ALSO", ".BR deltamapd (8),\n.BR deltamap (1)"))


NO_FILE = {"--set", "--initial-pose", "--title", "--only", "pose", "name", "HEX", "NAME"}  # text that names no file


def argument(name):
    """What an option's value or a positional may be: its words, separated by |, 'file' or 'any'; None: an option without value."""
    first, _, kind = name.partition(" ")
    among = re.match(r"TEXT:\{(.*?)\}", kind)
    if among:
        return among.group(1).replace(",", "|")
    if re.match(r"TEXT\b", kind):
        return "any" if {first, first.split(",")[-1]} & NO_FILE else "file"
    return "any" if re.match(r"(UINT|INT|FLOAT)\b", kind) else None


def completion(help):
    """One case per command: its subcommands, its options, what its arguments and its options' values may be."""
    cases = ""

    def add(one):
        nonlocal cases
        names = [name for name, _ in one.sections.get("Subcommands", [])]
        flags, values = [], []
        for name, _ in one.sections.get("Options", []):
            of_it = [word for word in name.split(" ")[0].split(",") if word.startswith("--")]
            flags += of_it
            if argument(name):
                values += ["%s:%s" % (word, argument(name)) for word in of_it]
        given = [argument(name) or "any" for name, _ in one.sections.get("Positionals", [])]
        cases += "    '%s') commands='%s' flags='%s' given=(%s) values+='%s ' ;;\n" % (
            " ".join(one.path[1:]), " ".join(names), " ".join(flags), " ".join("'%s'" % kind for kind in given), " ".join(values))
        for below in one.below:
            add(below)

    add(help)
    return """# bash completion of PROGRAM; written by packaging/manual.py
_PROGRAM() {
  local word option='' path='' commands flags given values=' ' at=0 kind=''
  local now=${COMP_WORDS[COMP_CWORD]}
  [[ $now != = ]] || now=''
  _PROGRAM_command
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == = ]]; then  # bash takes --map=FILE for three words
      continue
    elif [[ -n $option ]]; then
      option=''
    elif [[ $word == -* ]]; then
      [[ $values != *" $word:"* ]] || option=$word
    elif [[ " $commands " == *" $word "* ]]; then
      path+="${path:+ }$word" at=0
      _PROGRAM_command
    else
      at=$((at + 1))
    fi
  done
  if [[ -n $option ]]; then
    kind=${values#*" $option:"}
    kind=${kind%% *}
  elif [[ $now != -* ]]; then
    kind=${given[at]-}
  fi
  case $kind in
    file) COMPREPLY=() && compopt -o default ;;
    any) COMPREPLY=() ;;
    '') mapfile -t COMPREPLY < <(compgen -W "$commands $flags" -- "$now") ;;
    *) mapfile -t COMPREPLY < <(compgen -W "${kind//|/ }" -- "$now") ;;
  esac
}
_PROGRAM_command() {
  case $path in
CASES  esac
}
complete -F _PROGRAM PROGRAM
""".replace("CASES", cases).replace("PROGRAM", help.path[0])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    programs, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    day = time.strftime("%Y-%m-%d", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))))
    version = told([programs / "deltamapd", "--version"]).split()[1]
    daemon = read_help(programs / "deltamapd", ["deltamapd"], [])
    tool = read_help(programs / "deltamap", ["deltamap"], [])
    with tempfile.NamedTemporaryFile(suffix=".yaml") as nothing_set:
        listing = told([programs / "deltamapd", "--config", nothing_set.name, "--print-config"])
    out.mkdir(parents=True, exist_ok=True)
    for name, text in (("deltamapd.8", daemon_page(daemon, day, version)), ("deltamap.1", tool_page(tool, day, version)),
                       ("deltamap.yaml.5", settings_page(listing, day, version)), ("deltamap.completion", completion(tool)),
                       ("deltamapd.completion", completion(daemon))):
        (out / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
