#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/lower_case.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/elevation/elevation.h"

namespace canyon::scene {
/// ESRI ASCII grid: a header of ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize, NODATA_value,
/// then rows from the north. Its coordinate system stands in a .prj beside it, if anywhere.
Result<Elevation> read_ascii_grid(const std::string& path) {
  CANYON_TRY(std::string text, read_text_or_gzip_file(path));
  LineReader in(path, std::move(text));
  std::map<std::string, double> header{{"nodata_value", -9999.0}};
  Elevation out;
  std::string_view line;
  std::size_t expected = 0;
  while (in.next(line)) {
    throw_if_cancelled();
    const auto words = split(line, " \t", true);
    if (words.empty()) continue;
    if (out.height_m.empty() && std::isalpha(static_cast<unsigned char>(words[0][0])) && words.size() == 2 &&
        lower_case(words[0]) != "nan") {
      CANYON_TRY(header[lower_case(words[0])], parse_number(in, words[1]));
      continue;
    }
    if (out.columns == 0) {
      for (const char* key : {"ncols", "nrows", "cellsize"})
        if (!(header[key] > 0.0))
          return in.error("the header has no " + std::string(key), "ncols, nrows, xllcorner, yllcorner, cellsize");
      for (const char axis : {'x', 'y'})
        if (!header.contains(axis + std::string("llcorner")) && !header.contains(axis + std::string("llcenter")))
          return in.error("the header has no " + std::string(1, axis) + "llcorner",
                          "ncols, nrows, xllcorner, yllcorner, cellsize");
      if (!(header["ncols"] <= 1e5 && header["nrows"] <= 1e5 && header["ncols"] * header["nrows"] <= kLargestGrid))
        return in.error("a grid that large", "at most 400 million cells");
      out.columns = static_cast<int>(header["ncols"]);
      out.rows = static_cast<int>(header["nrows"]);
      expected = static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
    }
    for (const std::string_view word : words) {
      CANYON_TRY(const double value, parse_number(in, word));
      if (out.height_m.size() == expected)
        return in.error("more values than the header says", std::to_string(expected) + " values");
      out.height_m.push_back(value == header["nodata_value"] ? std::nanf("") : static_cast<float>(value));
    }
  }
  if (out.columns == 0 || out.height_m.size() != expected)
    return in.error(std::to_string(out.height_m.size()) + " values", std::to_string(expected) + " values");
  out.step_x = out.step_y = header["cellsize"];
  const double half = 0.5 * out.step_x;
  out.west = header.contains("xllcenter") ? header["xllcenter"] : header["xllcorner"] + half;
  out.north =
      (header.contains("yllcenter") ? header["yllcenter"] : header["yllcorner"] + half) + (out.rows - 1) * out.step_y;
  std::filesystem::path beside(path);
  if (beside.extension() == ".gz") beside.replace_extension();
  const auto wkt = read_text_file(beside.replace_extension(".prj").string());
  if (wkt) out.frame = {*wkt, false};
  return out;
}

}  // namespace canyon::scene
