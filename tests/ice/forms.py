"""A window's form with what the tests' workers look for in it, and with a connection to an overloaded slot."""

FORM = """\
<?xml version="1.0" encoding="UTF-8"?>
<ui version="4.0">
 <class>guiDlg</class>
 <widget class="{base}" name="guiDlg">
  <widget class="QWidget" name="inner">
   <widget class="QLabel" name="label"><property name="text"><string>none</string></property></widget>
   <widget class="QPushButton" name="button"/>
   <widget class="QSlider" name="slider"/>
   <widget class="QLCDNumber" name="digits"/>
  </widget>
 </widget>
 <connections>
  <connection>
   <sender>slider</sender><signal>valueChanged(int)</signal><receiver>digits</receiver><slot>display(int)</slot>
  </connection>
 </connections>
</ui>
"""
