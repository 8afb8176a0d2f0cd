# Debian's libexodusii-dev ships no CMake package: find its header and library, and netCDF's, in which it writes.
find_path(ExodusII_INCLUDE_DIR exodusII.h)
find_library(ExodusII_LIBRARY NAMES exoIIv2c exoIIv2 exodusii exodusII exodus)
find_library(ExodusII_NETCDF_LIBRARY NAMES netcdf)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ExodusII REQUIRED_VARS ExodusII_LIBRARY ExodusII_NETCDF_LIBRARY ExodusII_INCLUDE_DIR)
if(ExodusII_FOUND AND NOT TARGET ExodusII::ExodusII)
  add_library(ExodusII::ExodusII UNKNOWN IMPORTED)
  set_target_properties(ExodusII::ExodusII PROPERTIES IMPORTED_LOCATION "${ExodusII_LIBRARY}"
                        INTERFACE_LINK_LIBRARIES "${ExodusII_NETCDF_LIBRARY}"
                        INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${ExodusII_INCLUDE_DIR}")
endif()
