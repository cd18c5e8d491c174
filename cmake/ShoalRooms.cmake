# One CMake target a room.
#
#   shoal_room(<name> [SOURCES <file>...] [KERNELS <file>...] [SEES <room>...] [LIBRARIES <target>...])
#
# makes shoal::<name>. SOURCES are compiled once, KERNELS once an ISA. SEES are the rooms whose headers it may include;
# a user of the room sees them too. LIBRARIES are third-party targets, for the room's own sources only.
function(shoal_room name)
  cmake_parse_arguments(PARSE_ARGV 1 room "" "" "SOURCES;KERNELS;SEES;LIBRARIES")
  add_library(shoal_${name} INTERFACE)
  add_library(shoal::${name} ALIAS shoal_${name})
  target_link_libraries(shoal_${name} INTERFACE shoal_flags)
  if(room_SOURCES OR room_KERNELS)
    set(archive shoal_${name}_archive)
    add_library(${archive} STATIC ${room_SOURCES})
    set_target_properties(${archive} PROPERTIES OUTPUT_NAME shoal_${name} LINKER_LANGUAGE CXX)
    target_link_libraries(${archive} PRIVATE shoal_flags ${room_LIBRARIES})
    if(room_KERNELS)
      shoal_add_kernels(${archive} ${room_KERNELS})
      target_link_libraries(shoal_${name} INTERFACE $<LINK_LIBRARY:WHOLE_ARCHIVE,${archive}>)
    else()
      target_link_libraries(shoal_${name} INTERFACE ${archive})
    endif()
    foreach(seen IN LISTS room_SEES)
      target_link_libraries(${archive} PRIVATE shoal::${seen})
    endforeach()
  endif()
  foreach(seen IN LISTS room_SEES)
    target_link_libraries(shoal_${name} INTERFACE shoal::${seen})
  endforeach()
endfunction()

# shoal_sources(<variable> <pattern>...): the files that match, in alphabetical order, looked for again at each build.
macro(shoal_sources variable)
  file(GLOB ${variable} CONFIGURE_DEPENDS ${ARGN})
endmacro()
