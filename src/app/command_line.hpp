#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The command line as the commands see it. CLI11 is header-only and takes longer to compile than anything of ours, so
/// only `command_line.cpp` includes it.
namespace windlass::app {

/// A word or option of a command. Each call narrows what it accepts or says how the help shows it.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required();
  Option type(const std::string& name);   ///< what the help calls the value; empty: nothing
  Option group(const std::string& name);  ///< heading in the help
  Option default_shown();
  Option repeatable();       ///< one value each time it is given
  Option values(int count);  ///< so many values, given together
  Option between(double low, double high);
  Option between(int low, int high);
  Option positive();
  Option one_of(const std::vector<std::string>& words);
  /// @param complaint  says what is wrong with a word; empty where nothing is
  Option checked(const std::function<std::string(const std::string& word)>& complaint);
  Option excludes(Option other);

 private:
  CLI::Option* option_;
};

/// A command: what it takes and what it does. Values are written to the variables once everything is parsed, so these
/// must outlive the parsing; a name without dashes is a positional word.
class Command {
 public:
  explicit Command(CLI::App& command) : command_(&command) {}

  Option add(const std::string& name, std::string& value, const std::string& help);
  Option add(const std::string& name, std::filesystem::path& value, const std::string& help);
  Option add(const std::string& name, int& value, const std::string& help);
  Option add(const std::string& name, double& value, const std::string& help);
  Option add(const std::string& name, std::optional<double>& value, const std::string& help);
  Option add(const std::string& name, std::vector<std::string>& value, const std::string& help);
  Option add(const std::string& name, std::vector<double>& value, const std::string& help);
  /// Without a value; "!--name" makes it false.
  Option add_flag(const std::string& name, bool& value, const std::string& help);
  /// An option added before.
  Option option(const std::string& name);
  void footer(const std::string& text);
  /// What to do once this command is parsed.
  void run(std::function<void()> body);

 private:
  CLI::App* command_;
};

/// What can be said about an option, for the manual and for completion.
struct OptionText {
  std::string name;  ///< "--tolerance", or "SCENE" where it is positional
  std::string type, help, default_text;
  std::vector<std::string> long_names;  ///< "--tolerance"
  std::vector<std::string> choices;     ///< words it accepts; empty where it is not a choice
  bool positional = false, required = false, takes_value = false;
  bool common = false;        ///< one of those every command has
  bool help_request = false;  ///< --help
};

struct CommandText {
  std::string name, about, footer;
  std::vector<OptionText> options;
};

/// The whole command line.
class CommandLine {
 public:
  CommandLine(const std::string& about, const std::string& version, const std::string& footer);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  Command add_command(const std::string& name, const std::string& about);
  std::string help() const;
  /// The program itself: its description, footer and own options.
  CommandText describe() const;
  std::vector<CommandText> describe_commands() const;
  /// Parses, and runs what the command given does. Prints what --help and --version ask for, and what is wrong.
  /// @return false for words that cannot be understood
  bool parse(std::vector<std::string> arguments);

 private:
  std::unique_ptr<CLI::App> app_;
};

/// Heading of the options every command has.
inline constexpr const char* common_options_group = "Common options";

}  // namespace windlass::app
