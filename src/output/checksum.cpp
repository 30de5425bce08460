#include "windlass/output/checksum.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "windlass/output/error.hpp"

namespace windlass::output {

namespace {

constexpr std::string_view opening = "\nwindlass checksum ";
constexpr std::size_t digits = 16, line_length = opening.size() + digits + 1;

std::uint64_t mixed(std::uint64_t h, std::uint64_t word) {
  h = (h ^ word) * 0x9e3779b97f4a7c15u;  // odd: 2⁶⁴ over the golden ratio
  return h ^ (h >> 32);
}

}  // namespace

std::string checksum(std::string_view bytes) {
  std::uint64_t h = mixed(0, bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += sizeof h) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    h = mixed(h, word);
  }
  std::string text(digits, '0');
  for (std::size_t k = digits; k-- > 0; h >>= 4) text[k] = "0123456789abcdef"[h & 15];
  return text;
}

std::string sealed(std::string_view bytes) {
  std::string out(bytes);
  out += opening;
  out += checksum(bytes);
  return out += '\n';
}

std::string_view unsealed(std::string_view bytes, const std::string& file) {
  if (bytes.size() >= line_length) {
    const std::string_view line = bytes.substr(bytes.size() - line_length);
    const std::string_view content = bytes.substr(0, bytes.size() - line_length);
    if (line.starts_with(opening) && line.back() == '\n' &&
        line.substr(opening.size(), digits) == checksum(content))
      return content;
  }
  throw OutputError("cannot read " + file + ": it is truncated or damaged (its checksum does not fit)");
}

}  // namespace windlass::output
