# Third-party libraries, at the edges only: pictures, glTF, JSON, the command line.
find_package(PkgConfig REQUIRED)
# By pkg-config: OpenImageIO's own CMake package of Debian 12 needs its tools and OpenCV's headers installed too.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET GLOBAL OpenImageIO>=2.4)
find_package(TinyGLTF REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)
find_package(CLI11 REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
foreach(library TinyGLTF::TinyGLTF nlohmann_json::nlohmann_json CLI11::CLI11 fmt::fmt)
  set_target_properties(${library} PROPERTIES IMPORTED_GLOBAL TRUE)
endforeach()
