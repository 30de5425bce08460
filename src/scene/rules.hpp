#pragma once

#include <string>

#include "document.hpp"
#include "windlass/scene/error.hpp"
#include "windlass/scene/scene.hpp"

/// What must hold between the keys of a scene: which ones it needs, which ones exclude each other.
namespace windlass::scene {

/// `capstan.toml:5: load.angle: missing; with [cylinder] ...`, at the line of the table it belongs to.
SceneError missing(const Document& document, const std::string& key, const std::string& why);

/// Refuses a key that is given. @throws SceneError
void forbid(const Document& document, const std::string& key, const std::string& why);
/// The same whether it is given or not: then at the line of its table. @throws SceneError
[[noreturn]] void refuse_for(const Document& document, const std::string& key, const std::string& why);
/// Is a branch followed in this key?
bool starts_in(const Scene& scene, const std::string& key);

/// Rules of rods that stretch and of rods that weigh, a part of check_rules().
void check_stretch(const Document& document, const Scene& scene);
void check_weight(const Document& document, const Scene& scene);

/// Rules of ends on sliders, likewise.
void check_guides(const Document& document, const Scene& scene);

/// Rules of plates: at most two, the second with a height of its own; and what must hold between them, a part of check_rules().
void check_plates_given(const Document& document);
void check_plates(const Document& document, const Scene& scene);

/// @param restart  a branch begins at a stored point, wherever continuation.from is
/// @throws SceneError for the first rule that does not hold
void check_rules(const Document& document, const Scene& scene, bool restart);

}  // namespace windlass::scene
