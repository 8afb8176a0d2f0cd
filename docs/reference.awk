# Headers as Doxygen wants them: what one says at its top is about the file, which belongs to the group of its room.
# No line moves, so that warnings name the right ones.
FNR == 1 {
  room = FILENAME
  if (!sub(/.*include\/hextwist\//, "", room)) room = ""
  sub(/\/.*/, "", room)
  group = room == "" ? "" : "@ingroup " room
  heading = /^\/\/ /
}
heading && !/^\/\// {
  heading = 0
  if (/^#pragma once/) {
    print "/// " group
    getline
    if ($0 == "") $0 = "/// @file"
  }
}
heading { sub(/^\/\//, "///") }
{ print }
END { print "using namespace hextwist;" }
