#pragma once

#include <string>
#include <utility>
#include <vector>

#include "canyon/study/reproduce/reproduction.h"

namespace canyon::study {

/// Places in W, of two or three coordinates, as seen from above; one that is not finite cuts the line.
template <class Place>
PaperCurve from_above(std::string panel, std::string name, const std::vector<Place>& places_W) {
  PaperCurve out{.panel = std::move(panel), .unit = "m", .name = std::move(name), .x = {}, .y = {}, .from_above = true};
  for (const Place& p : places_W) {
    out.x.push_back(p.x());
    out.y.push_back(p.y());
  }
  return out;
}

}  // namespace canyon::study
