#pragma once

#include <string>
#include <string_view>

/// Checksums of what a run folder holds: a damaged file is refused before anything interprets it. HDF5 trusts the sizes
/// and addresses it reads, and may crash or never return on a damaged file.
namespace windlass::output {

/// 16 hexadecimal digits. Words of 8 bytes go through h ← (h xor w) · odd, h ← h xor (h >> 32), one-to-one in w and in
/// h: damage within one word always shows, any other but for one chance in 2⁶⁴.
std::string checksum(std::string_view bytes);

/// The bytes with their checksum in a last line; files that carry their own end like this.
std::string sealed(std::string_view bytes);

/// What stands before that line. @throws OutputError when it is missing or the checksum is another
/// @param file  for the message
std::string_view unsealed(std::string_view bytes, const std::string& file);

}  // namespace windlass::output
