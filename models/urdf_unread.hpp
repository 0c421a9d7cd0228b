// What stands in a URDF where something else would be read: a misspelt name must not become a
// silent default. Internal to models.
#pragma once

#include <tinyxml2.h>

#include "shapeid/models/note_list.hpp"

namespace shapeid::urdf {

/// Notes, with lines, attributes and elements of this link or joint that nobody reads though they
/// stand among those that are read, or are spelt almost like one. What URDF and its users add
/// besides (visuals, <gazebo>, sensors, calibrations) is no reason for a note.
void note_unread_in_link(const tinyxml2::XMLElement& link, NoteList& notes);
void note_unread_in_joint(const tinyxml2::XMLElement& joint, NoteList& notes);

}  // namespace shapeid::urdf
