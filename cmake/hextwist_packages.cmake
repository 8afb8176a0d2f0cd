# Debian packages by CPack, one for each component (see ./dev package): who runs the program needs no compiler, who
# builds on the library needs no MPI, and what the program stands on is found by dpkg-shlibdeps.
set(version ${HEXTWIST_SOVERSION})
set(package_program hextwist)
set(package_mpi hextwist-mpi)
set(package_library libhextwist${version})
set(package_development libhextwist-dev)
set(package_gmsh libhextwist-gmsh${version})
set(package_gmsh_development libhextwist-gmsh-dev)
set(package_python python3-hextwist)

set(components program development)
if(BUILD_SHARED_LIBS)
  list(APPEND components library)
endif()
foreach(pair hextwist_mpi=mpi hextwist_gmsh=gmsh hextwist_gmsh=gmsh_development hextwist_python=python)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 target)
  list(GET pair 1 component)
  if(TARGET ${target})
    list(APPEND components ${component})
  endif()
endforeach()

# What Debian wants to lie beside every package: who may copy it, and what is new.
string(TIMESTAMP HEXTWIST_YEAR "%Y" UTC)
string(TIMESTAMP HEXTWIST_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(folder ${PROJECT_BINARY_DIR}/debian)
configure_file(cmake/debian/copyright.in ${folder}/copyright @ONLY)
configure_file(cmake/debian/changelog.in ${folder}/changelog.Debian @ONLY)
find_program(HEXTWIST_GZIP gzip REQUIRED)
configure_file(CHANGELOG.md ${folder}/changelog COPYONLY)
foreach(name changelog changelog.Debian)
  execute_process(COMMAND ${HEXTWIST_GZIP} -9nkf ${folder}/${name} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
foreach(component IN LISTS components)
  install(FILES ${folder}/copyright ${folder}/changelog.gz ${folder}/changelog.Debian.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package_${component}} COMPONENT ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package_${component}})
  set(CPACK_DEBIAN_${upper}_FILE_NAME DEB-DEFAULT)
endforeach()
# Manual pages are packed.
install(CODE "
  file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1/hextwist*.[0-9]\"
       \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man7/hextwist*.[0-9]\")
  foreach(page IN LISTS pages)
    execute_process(COMMAND ${HEXTWIST_GZIP} -9nf \${page})
  endforeach()" ALL_COMPONENTS)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME hextwist)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each has its own
set(CPACK_PACKAGE_CONTACT "The hextwist authors <authors@hextwist.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_GMSH_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_GMSH_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})  # one of ours is made on another of ours
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(about "hextwist takes a CAD model and an all-hexahedral mesh of it, is told where
and how fine, and returns a mesh that is all-hexahedral, conformal, uninverted
and on the CAD, with every block, set and field carried over.")
function(description component summary more)
  string(TOUPPER ${component} upper)
  # CPack takes the first line as the summary, where there is no other.
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${about}\n\n${more}" PARENT_SCOPE)
endfunction()
description(program "local refinement of all-hexahedral meshes on CAD models" "This package has the program.")
description(mpi "local refinement of all-hexahedral meshes by several processes"
            "This package has the program that is started by mpirun.")
description(library "local refinement of all-hexahedral meshes, shared library"
            "This package has the library for C++ and C.")
description(development "local refinement of all-hexahedral meshes, headers"
            "This package has the headers, and what CMake and pkg-config look for.")
description(gmsh "local refinement of all-hexahedral meshes, in Gmsh's C++ API"
            "This package has the library that refines Gmsh's current model.")
description(gmsh_development "local refinement of all-hexahedral meshes, for Gmsh's C++ API"
            "This package has what CMake looks for; the header is in libhextwist-dev.")
description(python "local refinement of all-hexahedral meshes, for Python"
            "This package has the Python module, with meshes as numpy arrays.")

# What the library is told to read by others it reads in processes of their own, which the package of the program has.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS hextwist)
# Paves what 'mesh volume' cannot map.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS gmsh)
set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS "hextwist, openmpi-bin")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS hextwist)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-gmsh)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${package_library} ${same}, libeigen3-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "cmake, pkg-config")
set(CPACK_DEBIAN_GMSH_PACKAGE_DEPENDS "${package_library} ${same}")
set(CPACK_DEBIAN_GMSH_DEVELOPMENT_PACKAGE_DEPENDS "${package_gmsh} ${same}, ${package_development} ${same}, libgmsh-dev")
if(TARGET hextwist_python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${next}), python3-numpy")
endif()
# Who looks for libraries is told of new ones.
file(WRITE ${folder}/triggers "activate-noawait ldconfig\n")
foreach(component LIBRARY GMSH)
  set(CPACK_DEBIAN_${component}_PACKAGE_CONTROL_EXTRA ${folder}/triggers)
endforeach()
include(CPack)
