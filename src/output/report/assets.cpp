#include "assets.hpp"

// The assembler copies the files into the program: a C++ array of Plotly's 1.7 MB would take minutes to compile.
#define WINDLASS_EMBED(name, file)                                                                           \
  __asm__(".section .rodata\n.global windlass_" name "_begin\n.global windlass_" name "_end\nwindlass_" name \
          "_begin:\n.incbin \"" file "\"\nwindlass_" name                                                    \
          "_end:\n.byte 0\n"                                                                                 \
          ".previous\n")

WINDLASS_EMBED("page_html", WINDLASS_REPORT_FOLDER "/page.html");
WINDLASS_EMBED("page_css", WINDLASS_REPORT_FOLDER "/page.css");
WINDLASS_EMBED("page_js", WINDLASS_REPORT_FOLDER "/page.js");
WINDLASS_EMBED("tube_js", WINDLASS_REPORT_FOLDER "/tube.js");
#ifdef WINDLASS_PLOTLY_FILE
WINDLASS_EMBED("plotly", WINDLASS_PLOTLY_FILE);
#endif

extern "C" {
extern const char windlass_page_html_begin[], windlass_page_html_end[];
extern const char windlass_page_css_begin[], windlass_page_css_end[];
extern const char windlass_page_js_begin[], windlass_page_js_end[];
extern const char windlass_tube_js_begin[], windlass_tube_js_end[];
#ifdef WINDLASS_PLOTLY_FILE
extern const char windlass_plotly_begin[], windlass_plotly_end[];
#endif
}

namespace windlass::output::assets {

std::string_view page_html() { return {windlass_page_html_begin, windlass_page_html_end}; }
std::string_view page_css() { return {windlass_page_css_begin, windlass_page_css_end}; }
std::string_view page_js() { return {windlass_page_js_begin, windlass_page_js_end}; }
std::string_view tube_js() { return {windlass_tube_js_begin, windlass_tube_js_end}; }

std::string_view plotly_js() {
#ifdef WINDLASS_PLOTLY_FILE
  return {windlass_plotly_begin, windlass_plotly_end};
#else
  return {};
#endif
}

}  // namespace windlass::output::assets
