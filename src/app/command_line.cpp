#include "app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace windlass::app {

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::type(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::group(const std::string& name) {
  option_->group(name);
  return *this;
}

Option Option::default_shown() {
  option_->capture_default_str();
  return *this;
}

Option Option::repeatable() {
  option_->take_all()->expected(1);
  return *this;
}

Option Option::values(int count) {
  option_->expected(count);
  return *this;
}

Option Option::between(double low, double high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option Option::between(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option Option::checked(const std::function<std::string(const std::string& word)>& complaint) {
  option_->check([complaint](const std::string& word) { return complaint(word); });
  return *this;
}

Option Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Option Command::add(const std::string& name, std::string& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add(const std::string& name, std::filesystem::path& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add(const std::string& name, int& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add(const std::string& name, double& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add(const std::string& name, std::optional<double>& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add(const std::string& name, std::vector<std::string>& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add(const std::string& name, std::vector<double>& value, const std::string& help) {
  return Option(*command_->add_option(name, value, help));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(*command_->add_flag(name, value, help));
}

Option Command::option(const std::string& name) { return Option(*command_->get_option(name)); }

void Command::footer(const std::string& text) { command_->footer(text); }

void Command::run(std::function<void()> body) { command_->callback(std::move(body)); }

namespace {

/// Words an option accepts, which CLI11 keeps in the name of its type: TEXT:{png,svg,pdf}.
std::vector<std::string> choices_of(const std::string& type) {
  const auto open = type.find('{'), close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

OptionText text_of(const CLI::Option& option) {
  OptionText text;
  text.positional = option.get_positional();
  text.name = text.positional ? option.get_name(true) : option.get_name(false, true);
  text.name = text.name.substr(0, text.name.find('{'));  // CLI11 marks a flag that sets false
  text.type = option.get_type_name();
  text.help = option.get_description();
  text.default_text = option.get_default_str();
  for (const std::string& name : option.get_lnames()) text.long_names.push_back("--" + name);
  text.choices = choices_of(text.type);
  text.required = option.get_required();
  text.takes_value = option.get_items_expected_max() > 0;
  text.common = option.get_group() == common_options_group;
  return text;
}

CommandText text_of(const CLI::App& command) {
  CommandText text{command.get_name(), command.get_description(), command.get_footer(), {}};
  for (const CLI::Option* option : command.get_options()) {
    text.options.push_back(text_of(*option));
    text.options.back().help_request = option == command.get_help_ptr();
  }
  return text;
}

}  // namespace

CommandLine::CommandLine(const std::string& about, const std::string& version, const std::string& footer)
    : app_(std::make_unique<CLI::App>(about, "windlass")) {
  app_->set_version_flag("--version", version);
  app_->require_subcommand(1);
  app_->footer(footer);
  app_->get_formatter()->column_width(34);
}

CommandLine::~CommandLine() = default;

Command CommandLine::add_command(const std::string& name, const std::string& about) {
  return Command(*app_->add_subcommand(name, about));
}

std::string CommandLine::help() const { return app_->help(); }

CommandText CommandLine::describe() const { return text_of(*app_); }

std::vector<CommandText> CommandLine::describe_commands() const {
  std::vector<CommandText> texts;
  for (const CLI::App* command : app_->get_subcommands({})) texts.push_back(text_of(*command));
  return texts;
}

bool CommandLine::parse(std::vector<std::string> arguments) {
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
  try {
    app_->parse(arguments);
  } catch (const CLI::Success& request) {  // --help, --version
    return app_->exit(request) == 0;
  } catch (const CLI::ParseError& error) {
    app_->exit(error);  // prints the message and where help is
    return false;
  }
  return true;
}

}  // namespace windlass::app
