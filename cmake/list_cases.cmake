# cmake -DPROGRAM=FILE -DROOM=NAME -DSPEC=WHICH -DSLOW=TAG -DTOGETHER=TAG -DENVIRONMENT=TEXT
#       -DOUTPUT=FILE -P list_cases.cmake
# Writes OUTPUT, which ctest reads: a test "ROOM: NAME" for each test case of PROGRAM, a program made
# with Catch2. SPEC chooses cases as on its command line. Cases with the tag SLOW are started first,
# so that none of them is left for the end. Cases with the tag TOGETHER are run by one process.
# Catch2's own catch_discover_tests splits names at semicolons.
cmake_minimum_required(VERSION 3.25)

# list_cases(SPEC RESULT): names, with what CMake's lists cannot hold written as <words>.
function(list_cases spec result)
  execute_process(COMMAND ${PROGRAM} ${spec} --list-test-names-only OUTPUT_VARIABLE names)
  string(REPLACE ";" "<semicolon>" names "${names}")
  string(REPLACE "[" "<open>" names "${names}")
  string(REPLACE "]" "<close>" names "${names}")
  string(REPLACE "\n" ";" names "${names}")
  list(REMOVE_ITEM names "")
  set(${result} "${names}" PARENT_SCOPE)
endfunction()

function(as_written name result)
  string(REPLACE "<semicolon>" ";" name "${name}")
  string(REPLACE "<open>" "[" name "${name}")
  string(REPLACE "<close>" "]" name "${name}")
  set(${result} "${name}" PARENT_SCOPE)
endfunction()

list_cases("${SPEC}" cases)
if(NOT cases)
  message(FATAL_ERROR "${PROGRAM} lists no test case")
endif()
set(slow "")
if(SLOW)
  list_cases("${SPEC}${SLOW}" slow)
endif()
set(together "")
if(TOGETHER)
  list_cases("${SPEC}${TOGETHER}" together)
  list(REMOVE_ITEM cases ${together})
endif()

set(text "")
# add_case(NAME SPEC COST)
function(add_case name spec cost)
  string(APPEND text "add_test([==[${ROOM}: ${name}]==] [==[${PROGRAM}]==] [==[${spec}]==] --warn NoTests)\n"
         "set_tests_properties([==[${ROOM}: ${name}]==] PROPERTIES LABELS ${ROOM} COST ${cost}")
  if(ENVIRONMENT)
    string(APPEND text " ENVIRONMENT [==[${ENVIRONMENT}]==]")
  endif()
  set(text "${text})\n" PARENT_SCOPE)
endfunction()

if(together)
  add_case("all of ${TOGETHER}" "${SPEC}${TOGETHER}" 100)
endif()
foreach(case ${cases})
  set(cost 1)
  if(case IN_LIST slow)
    set(cost 50)
  endif()
  as_written("${case}" name)
  # What has a meaning in a choice of tests.
  string(REPLACE "\\" "\\\\" spec "${name}")
  string(REPLACE "\"" "\\\"" spec "${spec}")
  string(REPLACE "," "\\," spec "${spec}")
  string(REPLACE "[" "\\[" spec "${spec}")
  string(REPLACE "]" "\\]" spec "${spec}")
  add_case("${name}" "${spec}" ${cost})
endforeach()
file(WRITE ${OUTPUT} "${text}")
