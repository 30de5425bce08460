#include "windlass/output/report.hpp"

#include "report/assets.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/error.hpp"

namespace windlass::output {

namespace fs = std::filesystem;

namespace {

void replace_once(std::string& text, const std::string& mark, std::string_view by) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw OutputError("the page of the report lacks the mark " + mark);
  text.replace(at, mark.size(), by);
}

/// JSON as the content of a script element: "</" would end the element, "<!--" would open a comment.
std::string script_safe(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos; at += 6)
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string html_safe(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

}  // namespace

fs::path write_report(const Run& run, const ReportOptions& options) {
  if (assets::plotly_js().empty()) {
    throw OutputError(
        "this windlass was built without Plotly, which the report needs: install npm (Debian package npm), "
        "remove the "
        "build folder and build again with network access");
  }
  if (run.rows.empty()) throw OutputError("the run " + run.folder.string() + " holds no points to report");
  const fs::path file = options.file.empty() ? run.folder / "report.html" : options.file;
  std::string page(assets::page_html());
  replace_once(page, "<!--TITLE-->", html_safe(run.info.scene));
  replace_once(page, "/*STYLE*/", assets::page_css());
  replace_once(page, "/*TUBE*/", assets::tube_js());
  replace_once(page, "/*PAGE*/", assets::page_js());
  replace_once(page, "/*DATA*/", script_safe(report_data(run, options).dump()));
  replace_once(page, "/*PLOTLY*/", assets::plotly_js());
  replace_file(file, std::string_view(page));
  return file;
}

}  // namespace windlass::output
