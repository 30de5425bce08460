#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// A scene file as it stands: dotted keys with their values and places, nothing interpreted yet. The only part of
/// the program that sees the TOML library.
namespace windlass::scene {

/// A value that is none of the four kinds a scene has (an array, a date).
struct OtherValue {};

struct Entry {
  std::string key;    ///< dotted
  std::string place;  ///< "capstan.toml:7" or "--set"
  std::variant<double, std::int64_t, bool, std::string, OtherValue> value;
  std::string shown;                 ///< the value as the user wrote it, for messages
  std::vector<double> numbers = {};  ///< of an array of numbers
  std::vector<Entry> elements = {};  ///< of an array

  /// `capstan.toml:7: load.tension = -1: `, the beginning of every message about this entry.
  std::string prefix() const;
};

struct Document {
  std::string file;
  std::vector<Entry> entries;             ///< in file order, overrides replacing what they override
  std::map<std::string, int> tables;      ///< line of each [table]
  std::vector<std::vector<Entry>> walls;  ///< entries of each [[wall]]
  std::map<std::string, Entry> replaced;  ///< entries of the file that an override took the place of

  const Entry* find(std::string_view key) const;
  /// `capstan.toml:5`: where a missing key of that table belongs.
  std::string place_of_table(std::string_view table) const;
};

/// @throws SceneError if the file cannot be read or is not TOML, or an override is not KEY=VALUE
Document read_document(const std::filesystem::path& path, std::span<const std::string> overrides);

}  // namespace windlass::scene
