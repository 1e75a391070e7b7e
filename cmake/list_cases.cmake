# cmake -DPROGRAM=FILE -DROOM=NAME -DSPEC=WHICH -DSLOW=TAG -DTOGETHER=TAG -DAT_ONCE=COUNT
#       -DENVIRONMENT=TEXT -DCATCH=VERSION -DOUTPUT=FILE -P list_cases.cmake
# Writes OUTPUT, which ctest reads: a test "ROOM: NAME" for each test case of PROGRAM, a program made
# with Catch2 of VERSION. SPEC chooses cases as on its command line. Cases with the tag SLOW are started first,
# so that none of them is left for the end. Cases with the tag TOGETHER are run by one process. If
# AT_ONCE is above 1, one process runs so many of the other cases that are not SLOW.
# Catch2's own catch_discover_tests splits names at semicolons.
cmake_minimum_required(VERSION 3.22)

# How names are listed, and what makes it a failure that no case has the name that was given.
if(CATCH VERSION_LESS 3)
  set(list_names --list-test-names-only)
  set(insist " --warn NoTests")
else()
  set(list_names --list-tests --verbosity quiet)
  set(insist "")
endif()

# list_cases(SPEC RESULT): names, with what CMake's lists cannot hold written as <words>.
function(list_cases spec result)
  execute_process(COMMAND ${PROGRAM} ${spec} ${list_names} OUTPUT_VARIABLE names)
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

# as_spec(NAME RESULT): a name, with a backslash before what has a meaning in a choice of tests.
function(as_spec name result)
  string(REPLACE "\\" "\\\\" spec "${name}")
  string(REPLACE "\"" "\\\"" spec "${spec}")
  string(REPLACE "," "\\," spec "${spec}")
  string(REPLACE "[" "\\[" spec "${spec}")
  string(REPLACE "]" "\\]" spec "${spec}")
  set(${result} "${spec}" PARENT_SCOPE)
endfunction()

list_cases("${SPEC}" cases)
if(NOT cases)
  message(FATAL_ERROR "${PROGRAM} lists no test case")
endif()
# Those of the cases that have a tag of SLOW. Both choices may be several, "[a],[b]", so that one behind
# the other is no choice of what is in both.
set(slow "")
if(SLOW)
  list_cases("${SLOW}" tagged)
  foreach(case ${cases})
    if(case IN_LIST tagged)
      list(APPEND slow ${case})
    endif()
  endforeach()
endif()
set(together "")
if(TOGETHER)
  list_cases("${SPEC}${TOGETHER}" together)
  list(REMOVE_ITEM cases ${together})
  if(slow)
    list(REMOVE_ITEM slow ${together})
  endif()
endif()

set(text "")
# add_case(NAME COMMAND COST)
function(add_case name command cost)
  string(APPEND text "add_test([==[${ROOM}: ${name}]==] ${command})\n"
         "set_tests_properties([==[${ROOM}: ${name}]==] PROPERTIES LABELS ${ROOM} COST ${cost}")
  if(ENVIRONMENT)
    string(APPEND text " ENVIRONMENT [==[${ENVIRONMENT}]==]")
  endif()
  set(text "${text})\n" PARENT_SCOPE)
endfunction()

if(together)
  add_case("all of ${TOGETHER}" "[==[${PROGRAM}]==] [==[${SPEC}${TOGETHER}]==]${insist}" 100)
endif()

# add_groups(CASE...): processes of AT_ONCE cases. Each has a file with a choice of one case
# in each line, see tests/run_cases.sh.
function(add_groups)
  set(groups 0)
  set(rest ${ARGN})
  while(rest)
    list(SUBLIST rest 0 ${AT_ONCE} group)
    list(REMOVE_ITEM rest ${group})
    list(LENGTH group size)
    math(EXPR groups "${groups} + 1")
    set(file ${OUTPUT}.${groups}.txt)
    list(GET group 0 first)
    as_written("${first}" first)
    set(lines "")
    foreach(one ${group})
      as_written("${one}" name)
      as_spec("${name}" spec)
      string(APPEND lines "${spec}\n")
    endforeach()
    file(WRITE ${file} "${lines}")
    set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../tests/run_cases.sh)
    add_case("${size} cases from '${first}' on"
             "bash [==[${script}]==] [==[${PROGRAM}]==] [==[${file}]==]${insist}" 10)
  endwhile()
  set(text "${text}" PARENT_SCOPE)
endfunction()

if(AT_ONCE GREATER 1)
  if(slow)
    list(REMOVE_ITEM cases ${slow})
  endif()
  add_groups(${cases})
  set(cases ${slow})
endif()
foreach(case ${cases})
  set(cost 1)
  if(case IN_LIST slow)
    set(cost 50)
  endif()
  as_written("${case}" name)
  as_spec("${name}" spec)
  add_case("${name}" "[==[${PROGRAM}]==] [==[${spec}]==]${insist}" ${cost})
endforeach()
file(WRITE ${OUTPUT} "${text}")
