# Plants one fault, or none, and stops unless a test catches it:
#   cmake -D SOURCE=... -D TREE=... -D LIST=faults.json -D INDEX=... -D CXX=g++ -P plant_fault.cmake
if(INDEX STREQUAL none)
  set(name none)
  file(MAKE_DIRECTORY ${TREE})
else()
  include(${SOURCE}/kernels/tests/make_mutant.cmake)
endif()

set(tests event_windows_test agreement_test event_queue_test first_collision_test)
list(TRANSFORM tests REPLACE "(.+)" "${SOURCE}/kernels/tests/exact/\\1.cpp" OUTPUT_VARIABLE files)
execute_process(
  COMMAND ${CXX} -std=c++20 -O1 -w -ffp-contract=off -fopenmp -I ${TREE} -I ${SOURCE} ${files} -o ${TREE}/tests
    -lgtest -lgtest_main -pthread
  COMMAND_ERROR_IS_FATAL ANY)

set(enough 60) # seconds, several times what the tests take; not to end is a way to be caught
execute_process(COMMAND ${TREE}/tests --gtest_fail_fast --gtest_brief TIMEOUT ${enough}
  RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_QUIET)
string(REGEX MATCH "FAILED  \\] [^\n]*" failed "${said}")
message("fault ${name}: ${result} ${failed}")
if(name STREQUAL none AND NOT result EQUAL 0)
  message(FATAL_ERROR "the tests fail without a fault")
elseif(NOT name STREQUAL none AND result EQUAL 0)
  message(FATAL_ERROR "no test catches the fault ${name}")
endif()
file(REMOVE ${TREE}/tests)
