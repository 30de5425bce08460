#include "document.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "windlass/scene/error.hpp"
#include "windlass/scene/keys.hpp"

namespace windlass::scene {

namespace {

std::string read_text(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw SceneError(fmt::format("{}: is a directory; a scene file was expected", path.string()));
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream && !stream.eof())
    throw SceneError(
        fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno ? errno : EIO)));
  return text.str();
}

toml::table parse(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw SceneError(
        fmt::format("{}:{}: is not valid TOML: {}", file, error.source().begin.line, error.description()));
  }
}

/// An array or a date on one line, cut where it is long.
std::string shown_as_it_stands(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  std::string line = text.str();
  std::replace(line.begin(), line.end(), '\n', ' ');
  constexpr std::size_t longest = 40;
  return line.size() > longest ? line.substr(0, longest) + " ..." : line;
}

Entry make_entry(std::string key, std::string place, const toml::node& node) {
  Entry entry{std::move(key), std::move(place), OtherValue{}, {}};
  if (const auto* text = node.as_string()) {
    entry.value = text->get();
    entry.shown = fmt::format("\"{}\"", text->get());
  } else if (const auto* integer = node.as_integer()) {
    entry.value = integer->get();
    entry.shown = fmt::format("{}", integer->get());
  } else if (const auto* number = node.as_floating_point()) {
    entry.value = number->get();
    entry.shown = fmt::format("{}", number->get());
  } else if (const auto* flag = node.as_boolean()) {
    entry.value = flag->get();
    entry.shown = flag->get() ? "true" : "false";
  } else {
    entry.shown = shown_as_it_stands(node);
    if (const auto* array = node.as_array())
      for (const auto& element : *array) {
        if (const auto number = element.value<double>()) entry.numbers.push_back(*number);
        entry.elements.push_back(make_entry(entry.key, entry.place, element));
      }
  }
  return entry;
}

std::vector<Entry> entries_of(const toml::table& table, const std::string& prefix, const Document& document) {
  std::vector<Entry> entries;
  for (const auto& [key, node] : table)
    entries.push_back(make_entry(prefix + std::string(key.str()),
                                 fmt::format("{}:{}", document.file, node.source().begin.line), node));
  return entries;
}

/// Keys of the first [[plate]] are those of a single [plate], those of the next one begin with plate.2.
void add_plates(const toml::array& plates, Document& document) {
  int number = 0;
  for (const auto& element : plates) {
    const std::string prefix = ++number == 1 ? "plate." : fmt::format("plate.{}.", number);
    document.tables.try_emplace(prefix.substr(0, prefix.size() - 1),
                                static_cast<int>(element.source().begin.line));
    for (Entry& entry : entries_of(*element.as_table(), prefix, document))
      document.entries.push_back(std::move(entry));
  }
}

void flatten(const toml::table& table, const std::string& prefix, Document& document) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const int line = static_cast<int>(node.source().begin.line);
    const auto* array = node.as_array();
    if (name == "plate" && array && array->is_array_of_tables() && !array->empty()) {
      add_plates(*array, document);
      continue;
    }
    if (name == "wall" && array && array->is_array_of_tables()) {
      for (const auto& element : *array)
        document.walls.push_back(entries_of(*element.as_table(), "wall.", document));
    } else if (const auto* inner = node.as_table()) {
      document.tables[name] = line;
      flatten(*inner, name + ".", document);
    } else {
      document.entries.push_back(make_entry(name, fmt::format("{}:{}", document.file, line), node));
    }
  }
}

/// The value after `=`: as TOML if it is a TOML value, a bare word or phrase (`inf`, `2 pi`) otherwise.
Entry parse_override(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw SceneError(fmt::format("--set {}: must have the form KEY=VALUE, such as load.tension=2", text));
  const auto trim = [](std::string part) {
    part.erase(0, part.find_first_not_of(" \t"));
    part.erase(part.find_last_not_of(" \t") + 1);
    return part;
  };
  const std::string key = trim(text.substr(0, equals));
  const std::string value = trim(text.substr(equals + 1));
  try {
    const toml::table parsed = toml::parse("value = " + value);
    if (parsed.size() == 1 && !parsed.begin()->second.is_table())
      return make_entry(key, "--set", parsed.begin()->second);
  } catch (const toml::parse_error&) {
    // A bare word, or a number that TOML does not know as one: .5 and 5.
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error == std::errc() && end == value.data() + value.size())
      return make_entry(key, "--set", toml::value<double>(number));
  }
  return {key, "--set", value, value};
}

/// Sorted by place in the file, as a reader of the error messages expects the first mistake first.
int line_of(const Entry& entry) {
  const auto colon = entry.place.rfind(':');
  return colon == std::string::npos ? 0 : std::atoi(entry.place.c_str() + colon + 1);
}

}  // namespace

std::string Entry::prefix() const {
  const char* separator = place == "--set" ? " " : ": ";
  return fmt::format("{}{}{} = {}: ", place, separator, key, shown);
}

const Entry* Document::find(std::string_view key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [key](const Entry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::string Document::place_of_table(std::string_view table) const {
  const auto found = tables.find(std::string(table));
  return found == tables.end() || found->second == 0 ? file : fmt::format("{}:{}", file, found->second);
}

Document read_document(const std::filesystem::path& path, std::span<const std::string> overrides) {
  Document document;
  document.file = path.string();
  flatten(parse(read_text(path), document.file), "", document);
  std::stable_sort(document.entries.begin(), document.entries.end(),
                   [](const Entry& a, const Entry& b) { return line_of(a) < line_of(b); });
  for (const std::string& text : overrides) {
    Entry entry = parse_override(text);
    for (auto dot = entry.key.find('.'); dot != std::string::npos; dot = entry.key.find('.', dot + 1))
      if (dot == entry.key.find('.') || find_key(entry.key))
        document.tables.try_emplace(entry.key.substr(0, dot), 0);
    const auto old = std::find_if(document.entries.begin(), document.entries.end(),
                                  [&](const Entry& other) { return other.key == entry.key; });
    if (old == document.entries.end())
      document.entries.push_back(std::move(entry));
    else {
      if (old->place != "--set") document.replaced[old->key] = *old;
      *old = std::move(entry);
    }
  }
  return document;
}

}  // namespace windlass::scene
