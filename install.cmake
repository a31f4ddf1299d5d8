# Where an installed Carom has its parts: all of it in one folder that looks as a checkout does, so that the program finds
# what belongs to it in the same way, and what others look for as links into it.
set(home lib/carom)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(build gcc)
else()
  set(build clang)
endif()
install(TARGETS carom RUNTIME DESTINATION ${home}/build/${build} COMPONENT ${build})
install(TARGETS carom_variants_library LIBRARY DESTINATION ${home}/build/${build} COMPONENT ${build})
if(TARGET carom_libomp)
  install(TARGETS carom_libomp RUNTIME DESTINATION ${home}/build/${build} COMPONENT ${build})
endif()
if(NOT build STREQUAL "gcc")
  return() # the rest comes with g++'s build, which is always there
endif()

foreach(package IN ITEMS analysis experiments support)
  install(DIRECTORY ${package} DESTINATION ${home} COMPONENT gcc
    PATTERN tests EXCLUDE
    PATTERN __pycache__ EXCLUDE)
endforeach()
install(FILES harness/record.schema.json DESTINATION ${home}/harness COMPONENT gcc)
install(FILES VERSION LICENSE DESTINATION ${home} COMPONENT gcc)
install(CODE "
  set(prefix \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
  execute_process(COMMAND \"${PROJECT_SOURCE_DIR}/install.sh\" \"\${prefix}\"
    WORKING_DIRECTORY \"${PROJECT_SOURCE_DIR}\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT gcc)

# `make package`: both builds in one package, for the distribution that it is made on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME carom)
set(CPACK_PACKAGE_CONTACT "The Carom developers <carom@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Performance study that checks itself, with verdicts whose error rate is known")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/package.cmake)
include(CPack)
