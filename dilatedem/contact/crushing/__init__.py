"""Ice that crushes: no more force than the pressure of crushed ice on the nominal area of a contact.

`depth` finds how deep the ice has crushed, and is all that the laws ask for; `nominal` has the area that both undeformed bodies
would share, and `section` cuts and measures it.
"""
