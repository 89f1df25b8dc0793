#pragma once

namespace canyon::gnss {

/// What a search for ways leaves out, because it was shown that it finds nothing there (gnss/paths/need).
struct PathOmissions {
  bool occlusion = false;    ///< nothing stands above the lowest satellite: no ray along the straight way
  bool foliage = false;      ///< no crown on any straight way
  bool diffraction = false;  ///< no edge near any straight way
  int most_reflections = 3;  ///< ways over more walls than these are not searched

  bool operator==(const PathOmissions&) const = default;
};

}  // namespace canyon::gnss
