#include <fmt/format.h>

#include <CLI/CLI.hpp>
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

std::string option_entry(const CLI::Option& option) {
  std::string name = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
  name = name.substr(0, name.find('{'));  // CLI11 marks a flag that sets false
  std::string entry = ".TP\n\\fB" + roff(name) + "\\fR";
  const std::string type = option.get_type_name();
  if (!option.get_positional() && option.get_items_expected_max() > 0 && !type.empty())
    entry += " \\fI" + roff(type.substr(0, type.find(':'))) + "\\fR";
  entry += "\n" + roff(option.get_description());
  if (!option.get_default_str().empty() && option.get_items_expected_max() > 0)
    entry += roff(" (default " + option.get_default_str() + ")");
  return entry + "\n";
}

constexpr const char* common_group = "Common options";

std::string entries(const CLI::App& command, bool common) {
  std::string text;
  for (const bool positional : {true, false})
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional() == positional && (option->get_group() == common_group) == common &&
          !(option == command.get_help_ptr() && command.get_parent() != nullptr))
        text += option_entry(*option);
  return text;
}

std::string synopsis(const CLI::App& command) {
  std::string text = "windlass " + command.get_name();
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += option->get_required() ? " " + option->get_name(true) : " [" + option->get_name(true) + "]";
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

std::string manual_page(const CLI::App& app) {
  std::string text = fmt::format(".TH WINDLASS 1 \"\" \"windlass {}\" \"User Commands\"\n", WINDLASS_VERSION);
  const std::string about = app.get_description();
  text += ".SH NAME\nwindlass \\- " + roff(about.substr(about.find(':') + 2)) + "\n";
  text +=
      ".SH SYNOPSIS\n\\fBwindlass\\fR \\fICOMMAND\\fR \\fISCENE\\-or\\-RUN\\fR [options] [\\-\\- PETSc "
      "options]\n";
  text += ".SH COMMANDS\n";
  std::string common;
  for (const CLI::App* command : app.get_subcommands({})) {
    text += ".SS \"" + synopsis(*command) + "\"\n" + roff(command->get_description()) + ".\n" +
            entries(*command, false);
    if (!command->get_footer().empty()) text += ".PP\n" + prose(command->get_footer());
    if (common.empty()) common = entries(*command, true);
  }
  text += ".SH COMMON OPTIONS\n" + common + entries(app, false);
  return text + ".SH NOTES\n" + prose(app.get_footer().substr(1)) + run_folder() + scene_keys();
}

}  // namespace windlass::app
