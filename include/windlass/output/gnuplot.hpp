#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace windlass::output {

/// Lines that open a picture for every format: a gnuplot loop over formats, body, and its end.
struct Picture {
  std::string stem;     ///< file name without extension
  double width = 7.0;   ///< [inch]
  double height = 5.0;  ///< [inch]
  std::string body;     ///< gnuplot commands between `set output` and its closing
};

/// Writes STEM.gp in `folder` and runs gnuplot on it there.
/// @param formats  of png, svg, pdf; "png@80" has 80 dots an inch instead of 150
/// @return         the pictures made
/// @throws OutputError when the script cannot be written, gnuplot is missing, or it reports an error (quoted)
/// @throws DeviceError when a picture is not whole: gnuplot does not notice a full disk
std::vector<std::filesystem::path> run_gnuplot(const Picture& picture, const std::filesystem::path& folder,
                                               const std::vector<std::string>& formats);

/// A row of a data file; what is not finite becomes "?", the missing value of the scripts.
std::string data_line(const std::vector<double>& values);

/// Text in single quotes for gnuplot; in enhanced text mode _, ^, @, {, } and & lose their meaning.
std::string gnuplot_text(const std::string& text, bool enhanced = true);

/// Commands that place the next plot, in parts of the picture.
std::string margins(double left, double right, double bottom, double top);

/// Tics at 1, 2, 5 times powers of ten on a logarithmic axis ("xtics", "y2tics" ...), which often spans less than one
/// decade; at powers of ten alone on a long one.
std::string log_tics(const std::string& name, double low, double high);

}  // namespace windlass::output
