# The libraries Canyon stands on. Each is linked by one floor only (see docs/design.md).
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(embree 3 REQUIRED)
find_package(ZLIB REQUIRED)
# Scenes from files: map projections, GeoTIFF, XML. PROJ and libtiff are used directly: GDAL would bring a hundred shared libraries to
# the start of every run for one raster format.
if(CANYON_WITH_PROJ)
  find_package(PROJ REQUIRED)
endif()
find_package(TIFF REQUIRED)
find_package(LibXml2 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)

# Debian's GeographicLib installs its find module outside CMake's own search path.
find_path(GeographicLib_INCLUDE_DIR GeographicLib/Geocentric.hpp REQUIRED)
find_library(GeographicLib_LIBRARY NAMES GeographicLib Geographic REQUIRED)
add_library(canyon_geographiclib INTERFACE)
target_include_directories(canyon_geographiclib SYSTEM INTERFACE ${GeographicLib_INCLUDE_DIR})
target_link_libraries(canyon_geographiclib INTERFACE ${GeographicLib_LIBRARY})

# Header-only.
find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h REQUIRED)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)

if(CANYON_WITH_PCL)
  # pcl_io alone pulls in some sixty more shared libraries; Canyon writes its own cloud files. VTK, which PCL's configuration
  # looks for although none of these components needs it, would bring its libraries along, and wants MPI to be installed.
  set(CMAKE_DISABLE_FIND_PACKAGE_VTK ON)
  find_package(PCL 1.13 REQUIRED COMPONENTS common search kdtree filters registration)
endif()

if(CANYON_WITH_ASSIMP)
  find_package(assimp 5.2 REQUIRED)
endif()

if(CANYON_WITH_CERES)
  find_package(Ceres 2.1 REQUIRED)
endif()
