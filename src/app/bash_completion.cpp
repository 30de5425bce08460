#include <fmt/format.h>

#include <set>

#include "app/reference.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

namespace {

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// "scene", "run" or "label": what a positional word of that name is.
std::string kind_of(const std::string& positional) {
  if (positional == "SCENE") return "scene";
  return positional == "RUN" ? "run" : "label";
}

/// One branch of `case $command`.
std::string command_case(const CommandText& command) {
  std::vector<std::string> options, kinds;
  for (const OptionText& option : command.options) {
    if (option.positional) kinds.push_back(kind_of(option.name));
    options.insert(options.end(), option.long_names.begin(), option.long_names.end());
  }
  return fmt::format("    {}) options='{}'; kinds=({}) ;;\n", command.name, joined(options), joined(kinds));
}

/// Branches of `case $previous` for options with a fixed choice, the same in every command.
std::string choice_cases(const std::vector<CommandText>& commands) {
  std::set<std::string> seen;
  std::string text;
  for (const CommandText& command : commands)
    for (const OptionText& option : command.options)
      if (!option.choices.empty() && seen.insert(option.name).second)
        text += fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$word\")); return ;;\n", option.name,
                            joined(option.choices));
  return text;
}

/// Options without a value, of any command.
std::string flags(const std::vector<CommandText>& commands) {
  std::set<std::string> names;
  for (const CommandText& command : commands)
    for (const OptionText& option : command.options)
      if (!option.positional && !option.takes_value)
        names.insert(option.long_names.begin(), option.long_names.end());
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

std::string bash_completion(const CommandLine& app) {
  const std::vector<CommandText> commands = app.describe_commands();
  std::vector<std::string> names, keys;
  std::string cases;
  for (const CommandText& command : commands) {
    names.push_back(command.name);
    cases += command_case(command);
  }
  for (const scene::Key& key : scene::keys())
    if (key.table() != "scale") keys.emplace_back(key.name);
  return fmt::format(fmt::runtime(script), fmt::arg("commands", joined(names)),
                     fmt::arg("choices", choice_cases(commands)), fmt::arg("keys", joined(keys)),
                     fmt::arg("cases", cases), fmt::arg("flags", flags(commands)));
}

}  // namespace windlass::app
