#include <fmt/format.h>

#include <sstream>

#include "app/reference.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::app {

namespace {

/// Text in which roff finds no requests or escapes.
std::string roff(const std::string& text) {
  std::string out;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_start = c == '\n';
  }
  return out;
}

/// A footer: paragraphs as they stand, indented lines as examples.
std::string prose(const std::string& text) {
  std::string out;
  bool example = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with("  ");
    if (indented != example) out += indented ? ".PP\n.EX\n" : ".EE\n.PP\n";
    example = indented;
    out += line.empty() ? ".PP\n" : roff(line) + "\n";
  }
  return out + (example ? ".EE\n" : "");
}

std::string option_entry(const OptionText& option) {
  std::string entry = ".TP\n\\fB" + roff(option.name) + "\\fR";
  if (!option.positional && option.takes_value && !option.type.empty())
    entry += " \\fI" + roff(option.type.substr(0, option.type.find(':'))) + "\\fR";
  entry += "\n" + roff(option.help);
  if (!option.default_text.empty() && option.takes_value)
    entry += roff(" (default " + option.default_text + ")");
  return entry + "\n";
}

/// @param shown  which of the options
template <class Shown>
std::string entries(const CommandText& command, const Shown& shown) {
  std::string text;
  for (const bool positional : {true, false})
    for (const OptionText& option : command.options)
      if (option.positional == positional && shown(option)) text += option_entry(option);
  return text;
}

std::string synopsis(const CommandText& command) {
  std::string text = "windlass " + command.name;
  for (const OptionText& option : command.options)
    if (option.positional) text += option.required ? " " + option.name : " [" + option.name + "]";
  return roff(text) + " [options]";
}

std::string scene_keys() {
  std::string text = ".SH SCENE KEYS\nA scene is a TOML file. Any key can be set with \\fB\\-\\-set\\fR.\n";
  for (const scene::Key& key : scene::keys()) {
    if (key.table() == "scale") continue;  // only the program writes these
    text += ".TP\n\\fB" + roff(std::string(key.name)) + "\\fR\n" + roff(std::string(key.help));
    if (const std::string fallback = key.default_text(); !fallback.empty())
      text += roff(" (default " + fallback + ")");
    text += "\n";
  }
  return text;
}

std::string run_folder() {
  const std::pair<const char*, const char*> files[] = {
      {"scene.toml", "the scene as resolved, with everything that was set on the command line"},
      {"run.json", "version, options, machine, summary, lost branches, times"},
      {"branches.csv", "a row a point; written as points are found"},
      {"special_points.json", "folds, branch points and changes of contact, with their precision"},
      {"points.h5", "every solution along the rod, self-describing; what restarts and reports are made from"},
      {"checkpoint.cbor", "what --resume goes on from; gone once the run has come to its end"}};
  std::string text =
      ".SH RUN FOLDER\nFiles are replaced whole or grow by whole rows, so that the folder is readable at "
      "every "
      "moment.\n";
  for (const auto& [file, meaning] : files)
    text += ".TP\n\\fB" + roff(file) + "\\fR\n" + roff(meaning) + "\n";
  return text;
}

}  // namespace

std::string manual_page(const CommandLine& app) {
  const CommandText program = app.describe();
  std::string text = fmt::format(".TH WINDLASS 1 \"\" \"windlass {}\" \"User Commands\"\n", WINDLASS_VERSION);
  text += ".SH NAME\nwindlass \\- " + roff(program.about.substr(program.about.find(':') + 2)) + "\n";
  text +=
      ".SH SYNOPSIS\n\\fBwindlass\\fR \\fICOMMAND\\fR \\fISCENE\\-or\\-RUN\\fR [options] [\\-\\- PETSc "
      "options]\n";
  text += ".SH COMMANDS\n";
  std::string common;
  for (const CommandText& command : app.describe_commands()) {
    text += ".SS \"" + synopsis(command) + "\"\n" + roff(command.about) + ".\n" +
            entries(command, [](const OptionText& option) { return !option.common && !option.help_request; });
    if (!command.footer.empty()) text += ".PP\n" + prose(command.footer);
    if (common.empty()) common = entries(command, [](const OptionText& option) { return option.common; });
  }
  text += ".SH COMMON OPTIONS\n" + common + entries(program, [](const OptionText&) { return true; });
  return text + ".SH NOTES\n" + prose(program.footer.substr(1)) + run_folder() + scene_keys();
}

}  // namespace windlass::app
