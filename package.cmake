# Read by CPack: the builds that a package holds, and the Python that its environment was made for.
set(CPACK_INSTALL_CMAKE_PROJECTS "")
foreach(build IN ITEMS gcc clang)
  if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/build/${build}/carom)
    list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_CURRENT_LIST_DIR}/build/${build};carom;${build};/")
  endif()
endforeach()
execute_process(
  COMMAND ${CMAKE_CURRENT_LIST_DIR}/.venv/bin/python -c "import sys; print(*sys.version_info[:2], sys.version_info[1] + 1)"
  OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(python)
list(GET python 0 major)
list(GET python 1 minor)
list(GET python 2 next)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${major}.${minor}), python3 (<< ${major}.${next})")

# Debian's own tool says which packages the programs need. It wants a source package around it; the libraries that come
# with the Python environment it would not find, and need not.
set(around ${CMAKE_CURRENT_LIST_DIR}/build/package/around)
file(WRITE ${around}/debian/control "Source: carom\n\nPackage: carom\nArchitecture: any\n")
file(GLOB programs ${CMAKE_CURRENT_LIST_DIR}/build/gcc/carom ${CMAKE_CURRENT_LIST_DIR}/build/clang/carom)
execute_process(COMMAND dpkg-shlibdeps -O ${programs} WORKING_DIRECTORY ${around}
  OUTPUT_VARIABLE libraries OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${around})
string(REGEX REPLACE "^shlibs:Depends=" "" libraries "${libraries}")
string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", ${libraries}")
