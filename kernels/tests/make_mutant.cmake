# Copies the headers that a mutant is compiled from, and changes the one of them that the mutant is made of:
#   cmake -D SOURCE=... -D TREE=... -D LIST=mutants.json -D INDEX=... -P make_mutant.cmake
# Stops where the text to replace does not stand in it exactly once: a change of the kernel has to bring the mutant along.
file(READ ${LIST} list)
foreach(key name header replace by)
  string(JSON ${key} GET "${list}" ${INDEX} ${key})
endforeach()
file(COPY ${SOURCE}/kernels ${SOURCE}/variants DESTINATION ${TREE} FILES_MATCHING PATTERN "*.hpp" PATTERN tests EXCLUDE)
file(READ ${SOURCE}/${header} text)
string(FIND "${text}" "${replace}" first)
string(FIND "${text}" "${replace}" last REVERSE)
if(first EQUAL -1)
  message(FATAL_ERROR "mutant ${name}: ${header} does not contain the text to replace: ${replace}")
elseif(NOT first EQUAL last)
  message(FATAL_ERROR "mutant ${name}: ${header} contains the text to replace more than once: ${replace}")
endif()
string(REPLACE "${replace}" "${by}" text "${text}")
file(WRITE ${TREE}/${header} "${text}")
