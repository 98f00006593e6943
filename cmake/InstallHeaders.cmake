# Writes the public headers: those of weft/, with the headers of the tree that they include put in
# their place, each once, in the first public header that needs it; the others include that one. So
# what is installed is these files alone, and nobody comes to depend on how the tree is laid out.
#
# WEFT_SOURCE, WEFT_BINARY: the tree and its build folder; WEFT_HEADERS: names of the public headers,
# each behind those that it needs; WEFT_INCLUDES: where they go, below the prefix.

cmake_minimum_required(VERSION 3.23)
set(owned "")   # headers of the tree that are in a public header by now; home_<header>: in which

# Appends to `text` what the file holds. For a header of the language of kernels nothing is moved,
# since which lines count is decided by the compiler that reads them.
function(weft_inline file header)
  list(APPEND owned ${file})
  set(home_${file} ${header})
  file(READ ${WEFT_SOURCE}/${file} content)
  # What means something in lists of CMake goes by other names meanwhile.
  string(REPLACE "\\" "@BACKSLASH@" content "${content}")
  string(REPLACE ";" "@SEMICOLON@" content "${content}")
  string(REPLACE "[" "@OPEN@" content "${content}")
  string(REPLACE "]" "@CLOSE@" content "${content}")
  string(REPLACE "\n" ";" lines "${content}")
  foreach(line IN LISTS lines)
    if(line MATCHES "^#pragma once")
      continue()
    elseif(line MATCHES "^#include \"([^\"]+)\"")
      set(included ${CMAKE_MATCH_1})
      if(NOT included IN_LIST owned)
        weft_inline(${included} ${header})
      elseif(NOT home_${included} STREQUAL ${header} AND NOT home_${included} IN_LIST needed)
        list(APPEND needed ${home_${included}})
        string(APPEND text "#include <weft/${home_${included}}.h>\n")
      endif()
    elseif(line MATCHES "^#include <(.+)>" AND NOT header STREQUAL "kernel")
      if(NOT CMAKE_MATCH_1 IN_LIST standard)
        list(APPEND standard ${CMAKE_MATCH_1})
        string(APPEND text "${line}\n")
      endif()
    else()
      string(APPEND text "${line}\n")
    endif()
  endforeach()
  foreach(name IN ITEMS owned needed standard text)
    set(${name} "${${name}}" PARENT_SCOPE)
  endforeach()
  foreach(known IN LISTS owned)
    set(home_${known} ${home_${known}} PARENT_SCOPE)
  endforeach()
endfunction()

foreach(header IN LISTS WEFT_HEADERS)
  set(folder ${WEFT_BINARY}/public/weft)
  if(header STREQUAL "version")
    configure_file(${WEFT_BINARY}/include/weft/version.h ${folder}/version.h COPYONLY)
    continue()
  endif()
  set(text "")
  set(needed "")
  set(standard "")
  weft_inline(weft/${header}.h ${header})
  string(REPLACE "@OPEN@" "[" text "${text}")
  string(REPLACE "@CLOSE@" "]" text "${text}")
  string(REPLACE "@SEMICOLON@" ";" text "${text}")
  string(REPLACE "@BACKSLASH@" "\\" text "${text}")
  string(REGEX REPLACE "\n\n\n+" "\n\n" text "${text}")
  if(NOT header STREQUAL "kernel")
    string(PREPEND text "#pragma once\n")
  endif()
  file(WRITE ${folder}/${header}.h "${text}")
endforeach()

foreach(header IN LISTS WEFT_HEADERS)
  file(INSTALL ${WEFT_BINARY}/public/weft/${header}.h DESTINATION ${CMAKE_INSTALL_PREFIX}/${WEFT_INCLUDES})
endforeach()
