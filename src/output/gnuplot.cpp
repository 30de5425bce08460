#include "windlass/output/gnuplot.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"

namespace windlass::output {

namespace fs = std::filesystem;

namespace {

std::string extension(const std::string& format) { return format.substr(0, format.find('@')); }

/// Dots an inch of the PNG: 150, or what stands after "png@".
int dots_of(const std::vector<std::string>& formats) {
  for (const std::string& format : formats)
    if (format.starts_with("png@")) return std::clamp(std::atoi(format.c_str() + 4), 20, 1200);
  return 150;
}

std::string script_text(const Picture& picture, const std::vector<std::string>& formats) {
  std::string names;
  for (const std::string& format : formats) names += (names.empty() ? "" : " ") + extension(format);
  const int dots = dots_of(formats);
  char sizes[400];
  // one typeface and size for all formats: 11 points on paper
  std::snprintf(sizes, sizeof sizes,
                "  if (kind eq 'png') { set terminal pngcairo enhanced rounded size %.0f,%.0f font 'DejaVu "
                "Sans,10' fontscale "
                "%.3g linewidth %.3g }\n"
                "  if (kind eq 'svg') { set terminal svg enhanced rounded size %.0f,%.0f font 'DejaVu "
                "Sans,10' background "
                "'white' }\n"
                "  if (kind eq 'pdf') { set terminal pdfcairo enhanced rounded size %.2fin,%.2fin font "
                "'DejaVu Sans,10' }\n",
                picture.width * dots, picture.height * dots, dots / 100.0, dots / 100.0, picture.width * 96,
                picture.height * 96, picture.width, picture.height);
  return "# Makes " + picture.stem + ".{" + names + "}: run  gnuplot " + picture.stem +
         ".gp  in this folder.\n" + "set encoding utf8\nset minussign\n" + "do for [kind in '" + names +
         "'] {\n" + sizes + "  set output '" + picture.stem + ".'.kind\n" + picture.body +
         "  unset output\n  reset\n  set encoding utf8\n  set minussign\n}\n";
}

/// Every format has words at its end.
void require_whole(const fs::path& picture) {
  const std::string kind = picture.extension();
  const std::string_view end = kind == ".png" ? "IEND" : kind == ".svg" ? "</svg>" : "%%EOF";
  const std::string bytes = read_file(picture);
  if (bytes.find(end, bytes.size() - std::min<std::size_t>(bytes.size(), 64)) == std::string::npos)
    throw DeviceError("cannot write " + picture.string() + ": gnuplot left it incomplete, as on a full disk");
}

/// Text for a shell, in single quotes.
std::string shell_text(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::vector<fs::path> run_gnuplot(const Picture& picture, const fs::path& folder,
                                  const std::vector<std::string>& formats) {
  for (const std::string& format : formats) {
    const std::string kind = extension(format);
    if (kind != "png" && format != "svg" && format != "pdf") {
      throw OutputError("unknown picture format \"" + format + "\"; allowed are png, svg, pdf");
    }
  }
  const std::string script = picture.stem + ".gp";
  replace_file(folder / script, std::string_view(script_text(picture, formats)));
  const std::string command =
      "cd " + shell_text(folder.string()) + " && gnuplot " + shell_text(script) + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw OutputError("cannot start a shell for gnuplot");
  std::string messages;
  char buffer[512];
  while (fgets(buffer, sizeof buffer, pipe) != nullptr) messages += buffer;
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw OutputError("gnuplot is not installed (Debian package gnuplot-nox); the script " +
                      (folder / script).string() + " and its data are written");
  }
  if (status != 0) throw OutputError("gnuplot failed on " + (folder / script).string() + ": " + messages);
  std::vector<fs::path> pictures;
  for (const std::string& format : formats) {
    pictures.push_back(folder / (picture.stem + "." + extension(format)));
    require_whole(pictures.back());
  }
  return pictures;
}

std::string data_line(const std::vector<double>& values) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : " ") + (std::isfinite(value) ? format_number(value) : std::string("?"));
  return text + "\n";
}

std::string gnuplot_text(const std::string& text, bool enhanced) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
    } else if (enhanced && std::string_view("_^@{}&~").find(c) != std::string_view::npos) {
      quoted += "\\\\";
    }
    quoted += c;
  }
  return quoted + "\"";
}

std::string log_tics(const std::string& name, double low, double high) {
  std::string list;
  const bool long_axis = high / low > 500.0;
  for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::log10(high); ++e) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, e);
      if (value < low || value > high || (long_axis && digit != 1.0)) continue;
      list += (list.empty() ? "" : ", ") + std::string("'%g' ") + format_number(value);
    }
  }
  return "  set " + name + " (" + list + ")\n";
}

std::string margins(double left, double right, double bottom, double top) {
  return "  set lmargin at screen " + format_number(left) + "\n  set rmargin at screen " +
         format_number(right) + "\n  set bmargin at screen " + format_number(bottom) +
         "\n  set tmargin at screen " + format_number(top) + "\n";
}

}  // namespace windlass::output
