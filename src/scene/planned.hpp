#pragma once

#include "document.hpp"

/// Keys that the contract has and the program does not yet.
namespace windlass::scene {

/// Takes entries out of the document that say what holds without them, and refuses the others as not built yet. To
/// enable a key: give it its row in key_table.cpp and delete the one in planned.cpp.
/// @throws SceneError
void settle_planned(Document& document);

}  // namespace windlass::scene
