#pragma once

#include <stdexcept>

namespace windlass::output {

/// Something on disk could not be read or written; what() names the file and the reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The device gave out while results were written: it is full, over quota or broken. What was written before is whole.
class DeviceError : public OutputError {
 public:
  using OutputError::OutputError;
};

}  // namespace windlass::output
