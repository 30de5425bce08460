#pragma once

#include <stdexcept>

namespace windlass {

/// Something the user gave cannot be used: the program prints the message as it stands and exits with status 1.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace scene {

/// A scene that cannot be read. The message names file, line, key, the offending value and what is allowed:
/// `capstan.toml:7: load.tension = -1: must be > 0`.
class SceneError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace scene
}  // namespace windlass
