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
install(FILES reports/report.py reports/chart.py reports/stress.py reports/plot.py
        DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/oriel)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The man page and completions for shells, made by the program from its own tables.
function(orl_page form name folder)
    set(page ${CMAKE_CURRENT_BINARY_DIR}/pages/${name})
    add_custom_command(OUTPUT ${page} COMMAND oriel help --as ${form} > ${page} DEPENDS oriel VERBATIM)
    set_property(GLOBAL APPEND PROPERTY ORL_PAGES ${page})
    install(FILES ${page} DESTINATION ${folder})
endfunction()
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/pages)
orl_page(man oriel.1 ${CMAKE_INSTALL_MANDIR}/man1)
orl_page(bash oriel ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
# Debian's zsh looks into vendor-completions for what packages bring.
set(ORL_ZSH_DIR ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING
    "Where completions for zsh are installed")
orl_page(zsh _oriel ${ORL_ZSH_DIR})
orl_page(fish oriel.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
get_property(pages GLOBAL PROPERTY ORL_PAGES)
add_custom_target(pages ALL DEPENDS ${pages})
