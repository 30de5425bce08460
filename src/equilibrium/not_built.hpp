#pragma once

#include <string>
#include <string_view>

#include "windlass/chain/topology.hpp"

/// What a scene may ask for and is not built for some contacts, by the key that asks (RodProblem::missing_on): how it is told.
namespace windlass::equilibrium {

/// Does a strand that lies in a plate touch another? All that is free beside it is taken to lie there, which twisted it does not.
bool strands_in_plate(const chain::Topology& topology);

/// Of a scene whose state would have these contacts.
std::string not_built(std::string_view key);

/// Of contacts that a branch would lead to: what they are.
const char* contacts_not_built(std::string_view key);

}  // namespace windlass::equilibrium
