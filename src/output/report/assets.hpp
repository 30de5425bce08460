#pragma once

#include <string_view>

/// Files that are part of the program.
namespace windlass::output::assets {

std::string_view page_html();
std::string_view page_css();
std::string_view page_js();
std::string_view tube_js();
/// Empty when the program was built without npm.
std::string_view plotly_js();

}  // namespace windlass::output::assets
