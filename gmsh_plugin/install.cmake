# What `cmake --install` installs: headers, library, program, a CMake package and a pkg-config file.
# All of them find each other by relative paths, so the installed tree may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/meshgrow)
install(TARGETS meshgrow EXPORT meshgrow
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS meshgrow_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES meshgrow.h meshgrow.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# The library links nothing that its users would need to have for building, so the exported targets
# are the whole package.
install(EXPORT meshgrow FILE meshgrow-config.cmake NAMESPACE meshgrow::
  DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/meshgrow-config-version.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/meshgrow-config-version.cmake
  DESTINATION ${package_folder})

# From the folder of meshgrow.pc back to the prefix. Folders given absolutely stay where they are.
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
  set(pc_prefix ${CMAKE_INSTALL_PREFIX})
else()
  file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  set(pc_prefix "\${pcfiledir}/${to_prefix}")
endif()
foreach(kind LIBDIR INCLUDEDIR)
  string(TOLOWER pc_${kind} variable)
  if(IS_ABSOLUTE ${CMAKE_INSTALL_${kind}})
    set(${variable} ${CMAKE_INSTALL_${kind}})
  else()
    set(${variable} "\${prefix}/${CMAKE_INSTALL_${kind}}")
  endif()
endforeach()
configure_file(meshgrow.pc.in meshgrow.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/meshgrow.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

add_library(meshgrow::meshgrow ALIAS meshgrow)
