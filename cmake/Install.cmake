# cmake --install: program, library, headers, pkg-config file, CMake package, documentation.
include(CMakePackageConfigHelpers)
install(TARGETS oriel RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The program stays out of the export: its name is the library's there.
install(TARGETS liboriel EXPORT oriel-targets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
# The public headers, as <oriel/NAME.h>.
install(DIRECTORY include/oriel DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT oriel-targets NAMESPACE oriel:: FILE oriel-targets.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/oriel)
configure_package_config_file(cmake/oriel-config.cmake.in oriel-config.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/oriel)
write_basic_package_version_file(oriel-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/oriel-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/oriel-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/oriel)
# Relative, so that the installed tree can be moved.
file(RELATIVE_PATH ORL_PREFIX_FROM_LIBDIR "/${CMAKE_INSTALL_LIBDIR}" "/")
configure_file(cmake/oriel.pc.in oriel.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/oriel.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
