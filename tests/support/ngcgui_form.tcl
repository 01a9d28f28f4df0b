# SPDX-License-Identifier: GPL-2.0-or-later
# LinuxCNC's own ngcgui without its screen: a form read, filled in and written as a program.
#   tclsh ngcgui_form.tcl NGCGUI.TCL FORM.NGC PROGRAM.NGC [NUMBER=VALUE …]
# Prints a line for each field: number, name, default, comment, separated by tabs.
set arguments $argv
set argv {}
lassign $arguments source form program
source $source
foreach silent {new_image message readfile title conf} {
  proc ::ngcgui::$silent args {}
}
proc ::ngcgui::sendaxis args {return 1}
proc ::ngcgui::sendfile args {return 1}
::ngcgui::preset 0 ::ngc
array set ::ngc [list 0,data,section {} 0,data,preamble {} 0,data,postamble {} 0,savect 0 \
  0,fname,subfile $form 0,fname,autosend $program 0,top {} any,width,varname 0]
if {![::ngcgui::parse_ngc 0 ::ngc $form]} {
  puts stderr $::ngc(0,parse,msg)
  exit 1
}
unset ::ngc(any,dir,just)
puts "info\t$::ngc(0,info)"
for {set number 1} {$number <= $::ngc(0,argct)} {incr number} {
  set key [format %02d $number]
  set default {}
  catch {set default $::ngc(0,arg,dvalue,$key)}
  puts "$number\t$::ngc(0,arg,name,$key)\t$default\t$::ngc(0,arg,comment,$key)"
  set ::ngc(0,arg,value,$key) $default
}
foreach entry [lrange $arguments 3 end] {
  lassign [split $entry =] number value
  set ::ngc(0,arg,value,[format %02d $number]) $value
}
if {$program ne ""} {
  ::ngcgui::gui 0 savesection
  incr ::ngc(0,savect)
  ::ngcgui::gui 0 finalize
}
