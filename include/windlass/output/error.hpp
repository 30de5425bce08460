#pragma once

#include <stdexcept>

namespace windlass::output {

/// Something on disk could not be read or written; what() names the file and the reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace windlass::output
