#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "app/reference.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();  // TEXT:{png,svg,pdf}
  const auto open = type.find('{'), close = type.rfind('}');
  std::vector<std::string> words;
  if (open == std::string::npos || close == std::string::npos) return words;
  for (std::string& word : CLI::detail::split(type.substr(open + 1, close - open - 1), ','))
    words.push_back(word);
  return words;
}

namespace {

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// "scene", "run" or "label": what a positional word of that name is.
std::string kind_of(const std::string& positional) {
  if (positional == "SCENE") return "scene";
  return positional == "RUN" ? "run" : "label";
}

/// One branch of `case $command`.
std::string command_case(const CLI::App& command) {
  std::vector<std::string> options, kinds;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) kinds.push_back(kind_of(option->get_name(true)));
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  return fmt::format("    {}) options='{}'; kinds=({}) ;;\n", command.get_name(), joined(options),
                     joined(kinds));
}

/// Branches of `case $previous` for options with a fixed choice, the same in every command.
std::string choice_cases(const CLI::App& app) {
  std::vector<std::string> seen;
  std::string text;
  for (const CLI::App* command : app.get_subcommands({}))
    for (const CLI::Option* option : command->get_options()) {
      const auto choices = choices_of(*option);
      const std::string name = option->get_name(false, true);
      if (choices.empty() || std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
      seen.push_back(name);
      text += fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$word\")); return ;;\n", name,
                          joined(choices));
    }
  return text;
}

/// Options without a value, of any command.
std::string flags(const CLI::App& app) {
  std::set<std::string> names;
  for (const CLI::App* command : app.get_subcommands({}))
    for (const CLI::Option* option : command->get_options())
      if (!option->get_positional() && option->get_items_expected_max() == 0)
        for (const std::string& name : option->get_lnames()) names.insert("--" + name);
  return fmt::format("{}", fmt::join(names, " "));
}

constexpr const char* script = R"bash(# bash completion for windlass, made by `windlass completion`
_windlass() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}}
  local options='' kinds=() run='' place=0 i
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{commands} --help --version' -- "$word"))
    return
  fi
  case $previous in
{choices}    --set|--in) COMPREPLY=($(compgen -W '{keys}' -- "$word")); return ;;
    --csv|--out) COMPREPLY=($(compgen -f -- "$word")); return ;;
  esac
  case $command in
{cases}  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
    return
  fi
  for ((i = 2; i < COMP_CWORD; ++i)); do
    [[ ${{COMP_WORDS[i]}} == -* ]] && continue
    [[ ${{COMP_WORDS[i - 1]}} == -* && ' {flags} ' != *" ${{COMP_WORDS[i - 1]}} "* ]] && continue
    ((place == 0)) && run=${{COMP_WORDS[i]}}
    ((++place))
  done
  case ${{kinds[place]:-}} in
    scene) COMPREPLY=($(compgen -f -X '!*.toml' -- "$word") $(compgen -d -- "$word")) ;;
    run) COMPREPLY=($(compgen -d -- "$word")) ;;
    label) [[ -f $run/special_points.json ]] &&
      COMPREPLY=($(compgen -W "$(sed -n 's/.*"label": "\([^"]*\)".*/\1/p' "$run/special_points.json")" -- "$word")) ;;
  esac
}}
complete -o filenames -F _windlass windlass ./windlass
)bash";

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> commands, keys;
  std::string cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
    cases += command_case(*command);
  }
  for (const scene::Key& key : scene::keys())
    if (key.table() != "scale") keys.emplace_back(key.name);
  return fmt::format(fmt::runtime(script), fmt::arg("commands", joined(commands)),
                     fmt::arg("choices", choice_cases(app)), fmt::arg("keys", joined(keys)),
                     fmt::arg("cases", cases), fmt::arg("flags", flags(app)));
}

}  // namespace windlass::app
