#pragma once

#include <stdexcept>

namespace windlass::chain {

/// The chain's Newton matrix has no inverse at a state.
class SingularMatrix : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace windlass::chain
