#pragma once

#include <string>

#include "document.hpp"
#include "windlass/scene/keys.hpp"

/// One entry of a document against its row of the key table: kind, unit and range.
namespace windlass::scene {

struct Number {
  double value = 0.0;     ///< SI if it has a unit, rad for an angle, as it stands otherwise
  bool has_unit = false;  ///< of a dimensional key; angles have none
};

/// @param dimension, range  of `key`, or of the key that continuation.from and .to speak about
/// @throws SceneError
Number read_number(const Entry& entry, const Key& key, Dimension dimension, const Range& range);

/// @throws SceneError
bool read_truth(const Entry& entry, const Key& key);

/// @throws SceneError
std::string read_text(const Entry& entry, const Key& key);

/// True if the value is written with a unit ("inf" has none). @throws SceneError for a text that is no quantity
bool is_written_with_unit(const Entry& entry, const Key& key, Dimension dimension);

/// The number as the equations see it: what double precision cannot resolve beside quantities of size 1 is refused.
/// @throws SceneError
void check_size(const Entry& entry, const Key& key, double dimensionless);

/// Known keys and tables only. @throws SceneError with the nearest known key
void check_names(const Document& document);

}  // namespace windlass::scene
