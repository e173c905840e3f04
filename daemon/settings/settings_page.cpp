// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "daemon/settings/settings_documents.hpp"
#include "daemon/settings/settings_sections.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::string_view kIntroduction = R"(# Configuration

Every key of the settings file, section by section. A program writes this page: `deltamapd --print-configuration-md`.
How to choose the values that matter stands in [tuning](tuning.md).

One YAML file holds every setting; what it leaves out is as delivered. Keys stand one below the other, or by their dotted name
(`laser.mount.x_m: 0.02`), which is also that of `--set laser.mount.x_m=0.02` for one run. `deltamapd --config FILE --print-config` prints what
is in force, `--check-config` tells every mistake of the file at once.

*Live*: `deltamap ctl reload` takes the change while the daemon runs. *Restart*: it waits for the next start, and the reload says so.
*Symbol*: that of the paper with its equation ([paper](paper.md)), or of Thrun, Burgard and Fox, "Probabilistic Robotics", where they have one.

## Completion and checks in an editor

`/usr/share/deltamap/deltamap.schema.json` (`deltamapd --print-schema`) is a JSON schema of the file: names, meanings, ranges, defaults. An editor that
speaks to [yaml-language-server](https://github.com/redhat-developer/yaml-language-server) completes keys and words from it, shows each meaning and
marks what is wrong while it is typed. The delivered `deltamap.yaml` names it in its first line:

```yaml
# yaml-language-server: $schema=/usr/share/deltamap/deltamap.schema.json
```

- VS Code: the extension *YAML* (`redhat.vscode-yaml`) reads that line; nothing else is to be set.
- Neovim (`lspconfig.yamlls`), Vim (`coc-yaml`), Emacs (`lsp-mode` or `eglot`), Kate: install `yaml-language-server`; it reads that line.
- A file without that line: map it in the server's settings, `yaml.schemas: {"/usr/share/deltamap/deltamap.schema.json": "deltamap*.yaml"}`.

The schema knows keys that stand one below the other, not dotted names, and no rule that concerns two keys; `--check-config` knows all.
)";

/// A cell of a table: a bar would end it.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped.empty() ? " " : " " + escaped + " ";
}

std::string row(const SettingKey& key) {
  const std::string leaf = key.name.substr(key.name.rfind('.') + 1);
  return "|" + cell("`" + leaf + "`") + "|" + cell("`" + key.text() + "`") + "|" + cell(limits_of(key)) + "|" +
         cell(key.meaning) + "|" + cell(key.symbol) + "|" + cell(key.is_live ? "live" : "restart") + "|\n";
}

std::string heading(const std::string& section) {
  const std::string about = section.empty() ? "what belongs to no section" : meaning_of_section(section);
  return "\n## " + (section.empty() ? "Top" : "`" + section + "`") + "\n\n" + about +
         "\n\n| key | default | unit and range | meaning | symbol | live or restart |\n|---|---|---|---|---|---|\n";
}

}  // namespace

std::string settings_page() {
  Settings settings;
  std::string page(kIntroduction);
  std::string section = "none yet";
  for (const SettingKey& key : keys_of(settings)) {
    const auto dot = key.name.rfind('.');
    const std::string own = dot == std::string::npos ? "" : key.name.substr(0, dot);
    if (own != section) page += heading(own);
    section = own;
    page += row(key);
  }
  return page;
}

}  // namespace deltamap::daemon
