# Run at every build: writes build_info.hpp if what it says has changed, so that a program knows the source it was built
# from. Needs SOURCE_DIR, OUTPUT, COMPILER, FLAGS and BUILD_TYPE.
set(commit "")
set(dirty "")
set(diff_sha256 "")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} log -1 --format=%H -- kernels variants harness CMakeLists.txt
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(commit)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} status --porcelain -- kernels variants harness CMakeLists.txt
    OUTPUT_VARIABLE changes)
  set(dirty "false")
  if(changes)
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} diff HEAD -- kernels variants harness CMakeLists.txt
      OUTPUT_VARIABLE difference)
    string(SHA256 diff_sha256 "${changes}${difference}")
    set(dirty "true")
  endif()
endif()
string(JOIN "\n" text
  "#pragma once"
  ""
  "namespace carom::build_info {"
  ""
  "inline constexpr const char* compiler = \"${COMPILER}\";"
  "inline constexpr const char* flags = \"${FLAGS}\";"
  "inline constexpr const char* build_type = \"${BUILD_TYPE}\";"
  "inline constexpr const char* commit = \"${commit}\";"
  "inline constexpr const char* dirty = \"${dirty}\";"
  "inline constexpr const char* diff_sha256 = \"${diff_sha256}\";"
  ""
  "} // namespace carom::build_info"
  "")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}" @ONLY)
