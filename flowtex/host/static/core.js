// Built from client/src by client/build.js; change that instead.
/*! Holds parts of gl-matrix, of which this is the licence:

Copyright (c) 2015-2025, Brandon Jones, Colin MacKenzie IV.

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE. */
"use strict";var flowtex=(()=>{var __defProp=Object.defineProperty;var __getOwnPropDesc=Object.getOwnPropertyDescriptor;var __getOwnPropNames=Object.getOwnPropertyNames;var __hasOwnProp=Object.prototype.hasOwnProperty;var __export=(target,all)=>{for(var name in all)__defProp(target,name,{get:all[name],enumerable:!0})},__copyProps=(to,from,except,desc)=>{
if(from&&typeof from=="object"||typeof from=="function")for(let key of __getOwnPropNames(from))!__hasOwnProp.call(to,key)&&
key!==except&&__defProp(to,key,{get:()=>from[key],enumerable:!(desc=__getOwnPropDesc(from,key))||desc.enumerable});return to};var __toCommonJS=mod=>__copyProps(__defProp({},"__esModule",{value:!0}),mod);var core_exports={};__export(core_exports,{FlowtexView:()=>FlowtexView,Viewer:()=>Viewer,decoded:()=>decoded,initialize:()=>initialize,
mountPage:()=>mountPage,openPage:()=>openPage,packedModule:()=>packedModule,partsOfFile:()=>partsOfFile,render:()=>render});function fromHalf(bits){let exponent=bits>>10&31,part=bits&1023,size;return exponent===0?size=part*2**-24:exponent===31?
size=part?NaN:1/0:size=(1024+part)*2**(exponent-25),bits&32768?-size:size}var HALVES=Float32Array.from({length:65536},(_,bits)=>fromHalf(
bits)),SINGLE=new Float32Array(1),BITS=new Uint32Array(SINGLE.buffer);function toHalf(x){SINGLE[0]=x;let sign=BITS[0]>>>
16&32768,size=BITS[0]&2147483647;return size>=1199566848?sign|(size>2139095040?32256:31744):size<947912704?sign|Math.round(
Math.abs(x)*2**24):sign|size-93952e4>>>13}function checkSize(gl,width,height,layers=1){let most=gl.getParameter(gl.MAX_TEXTURE_SIZE),
mostLayers=gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS);if(Math.max(width,height)>most||layers>mostLayers)throw new Error(
`a texture of ${width} x ${height} texels in ${layers} layers is needed, but this graphics card supports at most ${most}\
 x ${most} in ${mostLayers}; show fewer nodes`)}function makeLayers(gl,texture,size){let{width,height,layers,channels,levels}=size;
checkSize(gl,width,height,layers);let target=gl.TEXTURE_2D_ARRAY;gl.bindTexture(target,texture),gl.texStorage3D(target,levels+
1,channels===1?gl.R16F:gl.RGBA16F,width,height,layers),gl.texParameteri(target,gl.TEXTURE_MIN_FILTER,gl.LINEAR_MIPMAP_LINEAR),
gl.texParameteri(target,gl.TEXTURE_MAG_FILTER,gl.LINEAR),gl.texParameteri(target,gl.TEXTURE_WRAP_S,gl.CLAMP_TO_EDGE),gl.
texParameteri(target,gl.TEXTURE_WRAP_T,gl.CLAMP_TO_EDGE)}var FORMAT=6,ZERO_SHARE=1e-5,AXES=["ticks","scale","none"],EARTH_LINES=["coastlines","graticule"],MARKS={critical:"criti\
cal_points",separatrices:"separatrices",nullclines:"nullclines"},LINE={saddle:8,orbit:4,leaving:2},TYPES={float32:Float32Array,
uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,int8:Int8Array,uint8:Uint8Array};function shareOf({
low,high,log}){if(!log)return value=>(value-low)/(high-low||1);let span=Math.log(high/low)||1;return value=>Math.log(Math.
max(value,low)/low)/span}function legendLimits({low,high,log}){let least=log?0:ZERO_SHARE*Math.max(Math.abs(low),Math.abs(
high)),told=value=>Math.abs(value)<least?0:value;return[told(low),told(high)]}function beyondEnds({low,high,choices,number}){
let{least,most}=choices[number]??{least:low,most:high},rounding=ZERO_SHARE*(most-least);return[low>least+rounding,high<most-
rounding]}function isSignFree(header){return header.variant.includes("FLOWTEX_SIGNFREE")}function stepOf(name){return Number(
name.split("/")[1])}function isOfStep(name,step,{scalars}){let[kind,own,number="0"]=name.split("/"),steps=scalars.choices[Number(
number)]?.steps??scalars.steps;return kind==="scalars"&&Number(own)===step&&steps>1}function tilePart(name){let[kind,level,
row2,column,...rest]=name.split("/");return kind==="tile"?[[level,row2,column].join("/"),rest.join("/")]:null}function decoded(info,bytes){
let view=ArrayBuffer.isView(bytes)?new Uint8Array(bytes.buffer,bytes.byteOffset,bytes.byteLength):new Uint8Array(bytes),
{name,dtype,shape:shape2,digest}=info,Type=TYPES[dtype];if(!Type)throw new Error(`a part has the type "${dtype}"; expect\
ed ${Object.keys(TYPES).join(", ")}`);return{name,shape:shape2,digest,data:new Type(view.slice().buffer)}}function partsOfFile(file){
let[infos,first]=infosOfFile(new Uint8Array(file)),start=first;return infos.map(info=>{let bytes=new Uint8Array(file,start,
info.bytes);return start+=info.bytes,info.differences===void 0?decoded(info,bytes):partOfPlanes(info,bytes)})}function infosOfFile(file){
let first=4+new DataView(file.buffer,file.byteOffset).getUint32(0,!0);return[JSON.parse(new TextDecoder().decode(file.subarray(
4,first))),first]}async function partOfText(info,text){return partOfPlanes(info,new Uint8Array(await unzipped(text).arrayBuffer()))}
function unzipped(text){let letters=atob(text),packed=new Uint8Array(letters.length);for(let n=0;n<packed.length;n+=1)packed[n]=
letters.charCodeAt(n);return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip")))}var UNSIGNED={
1:Uint8Array,2:Uint16Array,4:Uint32Array};function partOfPlanes(info,planes){let{shape:shape2,differences=[0,0],scale:scale3=null}=info,
count2=shape2.reduce((product2,n)=>product2*n,1),width=count2?planes.length/count2:1;if(!(width in UNSIGNED))throw new Error(
`the packing of the part "${info.name}" is invalid`);let[line,channels]=shape2.length>2?shape2.slice(-2):[...shape2,1].slice(
-2),numbers=new UNSIGNED[width](count2);for(let c=0,from=0;c<channels;c+=1)for(let n=c;n<count2;n+=channels,from+=1){let bits=0;
for(let plane=0;plane<width;plane+=1)bits|=planes[plane*count2+from]<<8*plane;numbers[n]=bits>>>1^-(bits&1)}let row2=line*
channels;for(let order=0;order<differences[0];order+=1)for(let n=row2;n<count2;n+=1)numbers[n]+=numbers[n-row2];for(let order=0;order<
differences[1];order+=1)for(let first=0;first<count2;first+=row2)for(let n=first+channels;n<first+row2;n+=1)numbers[n]+=
numbers[n-channels];return decoded(info,scale3?floats(numbers,scale3.map(exponent=>2**exponent)):numbers)}function floats(numbers,units){
let channels=units.length;return numbers instanceof Uint16Array?numbers.map((n,k)=>toHalf((n<<16>>16)*units[k%channels])):
new Float32Array(new Float64Array(numbers).map((n,k)=>(n|0)*units[k%channels]))}var EPSILON=1e-6,ARRAY_TYPE=typeof Float32Array<"u"?Float32Array:Array;var degree=Math.PI/180,radian=180/Math.PI;function transpose(out,a){if(out===a){var a01=a[1],a02=a[2],a12=a[5];out[1]=a[3],out[2]=a[6],out[3]=a01,out[5]=a[7],out[6]=
a02,out[7]=a12}else out[0]=a[0],out[1]=a[3],out[2]=a[6],out[3]=a[1],out[4]=a[4],out[5]=a[7],out[6]=a[2],out[7]=a[5],out[8]=
a[8];return out}function fromRotation(out,rad,axis){var x=axis[0],y=axis[1],z=axis[2],len=Math.sqrt(x*x+y*y+z*z),s,c,t;return len<EPSILON?
null:(len=1/len,x*=len,y*=len,z*=len,s=Math.sin(rad),c=Math.cos(rad),t=1-c,out[0]=x*x*t+c,out[1]=y*x*t+z*s,out[2]=z*x*t-
y*s,out[3]=0,out[4]=x*y*t-z*s,out[5]=y*y*t+c,out[6]=z*y*t+x*s,out[7]=0,out[8]=x*z*t+y*s,out[9]=y*z*t-x*s,out[10]=z*z*t+c,
out[11]=0,out[12]=0,out[13]=0,out[14]=0,out[15]=1,out)}function create(){var out=new ARRAY_TYPE(3);return ARRAY_TYPE!=Float32Array&&(out[0]=0,out[1]=0,out[2]=0),out}function length(a){var x=a[0],y=a[1],z=a[2];return Math.sqrt(x*x+y*y+z*z)}function subtract(out,a,b){return out[0]=a[0]-b[0],out[1]=a[1]-b[1],out[2]=a[2]-b[2],out}function scale(out,a,b){return out[0]=a[0]*b,out[1]=a[1]*b,out[2]=a[2]*b,out}function scaleAndAdd(out,a,b,scale3){return out[0]=
a[0]+b[0]*scale3,out[1]=a[1]+b[1]*scale3,out[2]=a[2]+b[2]*scale3,out}function normalize(out,a){var x=a[0],y=a[1],z=a[2],len=x*x+y*y+z*z;return len>0&&(len=1/Math.sqrt(len)),out[0]=a[0]*len,
out[1]=a[1]*len,out[2]=a[2]*len,out}function dot(a,b){return a[0]*b[0]+a[1]*b[1]+a[2]*b[2]}function cross(out,a,b){var ax=a[0],
ay=a[1],az=a[2],bx=b[0],by=b[1],bz=b[2];return out[0]=ay*bz-az*by,out[1]=az*bx-ax*bz,out[2]=ax*by-ay*bx,out}function transformMat4(out,a,m){var x=a[0],y=a[1],z=a[2],w=m[3]*x+m[7]*y+m[11]*z+m[15];return w=w||1,out[0]=(m[0]*x+m[4]*
y+m[8]*z+m[12])/w,out[1]=(m[1]*x+m[5]*y+m[9]*z+m[13])/w,out[2]=(m[2]*x+m[6]*y+m[10]*z+m[14])/w,out}function transformMat3(out,a,m){
var x=a[0],y=a[1],z=a[2];return out[0]=x*m[0]+y*m[3]+z*m[6],out[1]=x*m[1]+y*m[4]+z*m[7],out[2]=x*m[2]+y*m[5]+z*m[8],out}var forEach=(function(){var vec=create();return function(a,stride,offset,count2,fn,arg){var i,l;for(stride||(stride=3),offset||
(offset=0),count2?l=Math.min(count2*stride+offset,a.length):l=a.length,i=offset;i<l;i+=stride)vec[0]=a[i],vec[1]=a[i+1],
vec[2]=a[i+2],fn(vec,vec,arg),a[i]=vec[0],a[i+1]=vec[1],a[i+2]=vec[2];return a}})();var v=a=>a,result=()=>[0,0,0],zeros=n=>new Array(n).fill(0),dot2=(a,b)=>dot(v(a),v(b)),length2=a=>length(v(a)),subtract2=(a,b)=>subtract(
result(),v(a),v(b)),scale2=(a,by)=>scale(result(),v(a),by),cross2=(a,b)=>cross(result(),v(a),v(b)),unit=a=>normalize(result(),
v(a)),add=(a,b,t=1)=>scaleAndAdd(result(),v(a),v(b),t);function rotated(a,axis,degrees){let turn=fromRotation(zeros(16),
degrees*Math.PI/180,v(axis));return turn===null?result():transformMat4(result(),v(a),turn)}function toFrame(frame,a){let columns=transpose(
zeros(9),frame);return transformMat3(result(),v(a),columns)}function fromFrame(frame,a){return transformMat3(result(),v(
a),frame)}function clamp(x,low,high){return Math.min(Math.max(x,low),high)}var OWN="own cmap",MOST_STEPS=32,SRGB={knee:.04045,slope:12.92,offset:.055,scale:1.055,power:2.4};function coloursOf(header){
let{scalars,colour,background,lighting,opacity,earth}=header;return{scalars,colour,background,lighting,opacity,earth}}var ENTRIES=256;
function mapOf({scalars},maps,name,norm){let{entries,flip,maps:names}=scalars,table=norm?norm.slice():new Uint8Array(4*entries).
fill(255),last=table.length/4-1||1;return table.map((own,at)=>{let[n,k]=[at>>2,at&3],place=Math.round((flip?last-n:n)/last*
(ENTRIES-1));return k===3?own:maps[3*(names.indexOf(name)*ENTRIES+place)+k]})}function texelsOf(map,{beyond}){let count2=map.
length/4,norm=map instanceof Float32Array;return Float32Array.from({length:map.length+12},(_,at)=>{let[n,k]=[at>>2,at&3],
own=map[4*clamp(n-1,0,count2-1)+k];return k===3?norm?n?own:1:0:(n>count2?beyond[n-count2]:n?null:beyond[0])?.[k]??own/255})}
function placeOf(scalars,map){let share=shareOf(scalars);if(!(map instanceof Float32Array))return share;let count2=map.length/
4,edge=n=>n<count2?map[4*n+3]:1;return value=>{let at=share(value),n=0;for(;n<count2-1&&edge(n+1)<=at;)n+=1;return(n+clamp(
(at-edge(n))/(edge(n+1)-edge(n)||1),0,1))/count2}}function choiceOf({scalars},name){let[before,after]=[scalars.name,name].
map(each=>scalars.choices.find(one=>one.name===each)),cmap=after?.cmap!==before?.cmap&&scalars.cmap===before?.cmap?after?.
cmap:void 0;return{scalars:name,clim:null,...cmap&&{cmap}}}function recoloured(header,choice,parts){let scalars={...header.
scalars};choice.scalars===!1&&(scalars.name=null);let number=scalars.choices.findIndex(({name})=>name===choice.scalars);
if(number>=0){let{name,label,unit:unit3,steps,flat}=scalars.choices[number];Object.assign(scalars,{name,label,unit:unit3,
steps,flat,number,auto:!0})}if(choice.cmap&&(scalars.cmap=choice.cmap),Array.isArray(choice.clim)&&([scalars.low,scalars.
high]=choice.clim),choice.clim!==void 0&&(scalars.auto=!choice.clim),scalars.auto&&scalars.choices[scalars.number]){let{
cmap="",least,...usual}=scalars.choices[scalars.number],isWhole=scalars.log&&least>0,[low,high]=isWhole?[least,usual.most]:
[usual.low,usual.high],widest=(low<0&&high>0||scalars.diverging.includes(cmap))&&scalars.diverging.includes(scalars.cmap),
end=Math.max(-low,high);[scalars.low,scalars.high]=widest?[-end,end]:[low,high]}let{coastlines=header.earth?.coastlines,
graticule=header.earth?.graticule}=choice,earth=header.earth&&{...header.earth,coastlines,graticule},{opacity=header.opacity}=choice,
colours={scalars,earth,opacity},[maps,map]=[parts.get("maps"),parts.get("cmap")?.data],norm=map instanceof Float32Array,
ends2=norm&&(choice.clim!==void 0||choice.scalars!==void 0);if(!maps||!(choice.cmap||ends2))return{colours,part:null};ends2&&
Object.assign(scalars,{ticks:[],beyond:[null,null,scalars.beyond[2]]});let own=norm&&!ends2,data=choice.cmap?mapOf(header,
maps.data,choice.cmap,own?map:void 0):Uint8Array.from(map??[]),digest=[OWN,choice.cmap,own].join();return{colours,part:{
name:"cmap",data,shape:[data.length/4,4],digest}}}var toLinear=c=>c<SRGB.knee?c/SRGB.slope:((c+SRGB.offset)/SRGB.scale)**
SRGB.power;function fromLinear(x){let c=clamp(x,0,1);return c<SRGB.knee/SRGB.slope?c*SRGB.slope:SRGB.scale*c**(1/SRGB.power)-
SRGB.offset}var times=(v2,m)=>[0,1,2].map(k=>v2[0]*m[k]+v2[1]*m[3+k]+v2[2]*m[6+k]);function meanColour(colour,settings,shading){
let{values}=shading,[[dark,light],[range,slope]]=[shading.base,shading.tone],[strength,contrast]=[Number(settings.strength),
Number(settings.contrast)],cones=times(colour.map(c=>toLinear(c/255)),shading.toCones).map(Math.cbrt),[lightness,a,b]=times(
cones,shading.toLab),base=lightness+strength*(dark+(light-dark)*lightness-lightness),mean=[0,0,0];return values.forEach(
value=>{let tone=2/(1+Math.exp(-slope*contrast*value))-1,shown=clamp(base+range*strength*tone,0,1),roots=times([shown,a,
b],shading.fromLab),linear=times(roots.map(x=>x**3),shading.fromCones),grey=shown**3,rooms=linear.map(x=>Math.abs(+(x>=grey)-
grey)/Math.max(Math.abs(x-grey),1e-6)),room=Math.min(...rooms,1);linear.forEach((x,k)=>mean[k]+=255*fromLinear(grey+room*
(x-grey))/values.length)}),mean}function runsOf(map){let runs=[];for(let n=0;n<map.length/4;n+=1)n>0&&[0,1,2].every(k=>map[4*
n+k]===map[4*n-4+k])?runs[runs.length-1][1]=n+1:runs.push([n,n+1]);return runs}function rampOf(map,header,settings,stops){
let count2=map.length/4,hasOwn=!!header.image&&!header.image?.deviations,shown=n=>{let colour=[...map.slice(4*n,4*n+3)];
return`rgb(${(hasOwn?colour:meanColour(colour,settings,header.constants.shading)).map(Math.round).join(" ")})`},runs=runsOf(
map);return`linear-gradient(90deg, ${(runs.length<=MOST_STEPS?runs.map(([from,to])=>`${shown(from)} ${100*from/count2}% ${100*
to/count2}%`):Array.from({length:stops},(_,n)=>shown(Math.round(n/(stops-1)*(count2-1))))).join(", ")})`}var NORTH=[0,0,1],STEEPEST=Math.sin(89*Math.PI/180),LEAST_COSINE=.2,LEAST_PARALLEL=.8,tangent=degrees=>Math.tan(degrees*
Math.PI/360),Camera=class{flat;limits;aspect;state;start;pick=null;globe;homeHeight;nearest;constructor(state,limits,flat,aspect=1,globe=0){
this.state=copyOf(state),this.start=copyOf(state),this.limits=limits,this.flat=flat,this.globe=globe,this.aspect=aspect,
this.homeHeight=this.height,this.nearest=this.distance/limits.closest}get height(){let{parallel,parallel_scale:half,view_angle:angle}=this.
state;return parallel?half:this.distance*tangent(angle)}get distance(){return length2(subtract2(this.state.focal_point,this.
state.position))}get zoom(){return this.homeHeight/this.height}get axes(){let ahead=unit(subtract2(this.state.focal_point,
this.state.position)),right=unit(cross2(ahead,this.state.up));return[right,cross2(right,ahead),ahead]}sight(pixels){let{
parallel,position,view_angle:angle}=this.state;return parallel?{eye:null,halfHeight:this.height,pixels}:{eye:position,halfHeight:tangent(
angle),pixels}}get planes(){let[right,up,ahead]=this.axes,{parallel,parallel_scale:half,view_angle:angle}=this.state,{position,
focal_point:focus}=this.state,tall=parallel?half:tangent(angle);return[right,scale2(right,-1),up,scale2(up,-1)].map((side,n)=>{
let size=n<2?tall*this.aspect:tall;if(parallel)return[...side,size-dot2(side,focus)];let normal=add(side,ahead,size);return[
...normal,-dot2(normal,position)]})}get eye(){return this.state.parallel?[...scale2(this.axes[2],-1),0]:[...this.state.position,
1]}at(point){let ahead=this.axes[2];if(this.state.parallel)return{height:this.height,ray:ahead};let way=subtract2(point,
this.state.position);return{height:dot2(way,ahead)*tangent(this.state.view_angle),ray:unit(way)}}project(point){let[right,
up]=this.axes,{height}=this.at(point);if(!(height>0))return null;let{parallel,position,focal_point:focus}=this.state,way=subtract2(
point,parallel?focus:position);return[dot2(right,way)/height/this.aspect,dot2(up,way)/height]}pan(dx,dy){let[right,up]=this.
axes,{height}=this;this.shift(add(scale2(right,dx*this.aspect*height),up,dy*height))}rotate(dx,dy){if(this.globe)return this.
roam(dx,dy);let{state,limits}=this,up=unit(state.up),back=subtract2(state.position,state.focal_point);back=rotated(back,
up,-limits.turn*dx*Math.min(this.aspect,limits.widest_turn));let right=unit(cross2(up,back));back=rotated(back,right,limits.
turn*dy),state.position=add(state.focal_point,back),state.up=unit(cross2(back,right))}roam(dx,dy){let{state,limits,globe}=this,
away=length2(state.position),above=Math.max(away-globe,0)*tangent(state.view_angle),height=state.parallel?state.parallel_scale:
above,degrees=Math.min(height/globe*180/Math.PI,limits.turn),cosine=Math.hypot(state.position[0],state.position[1])/away,
aside=Math.min(degrees*this.aspect/Math.max(cosine,LEAST_COSINE),limits.turn);this.turn(NORTH,-aside*dx);let[right]=this.
axes,steep=Math.abs(state.position[2])/away,before=copyOf(state);this.turn(right,degrees*dy),Math.abs(state.position[2])/
away>Math.max(STEEPEST,steep)&&(this.state=before);let[,,ahead]=this.axes,upward=add(NORTH,ahead,-dot2(NORTH,ahead));length2(
upward)>1-STEEPEST&&(this.state.up=unit(upward))}turn(axis,degrees){let{state}=this;for(let name of["position","focal_po\
int","up"])state[name]=rotated(state[name],axis,degrees)}zoomBy(factor,x=0,y=0){if(!Number.isFinite(factor)||factor<=0)return;
this.flat||this.focusAt(x,y);let{farthest_zoom:farthest,deepest_zoom:deepest}=this.limits,by=clamp(factor,farthest/this.
zoom,deepest/this.zoom),[right,up,ahead]=this.axes,height=this.height*(1-1/by);this.shift(add(scale2(right,x*this.aspect*
height),up,y*height)),this.state.parallel?this.state.parallel_scale/=by:this.approach(this.height/by,ahead)}ray(x,y){let[
right,up,ahead]=this.axes,{height,state}=this,there=add(add(state.focal_point,right,x*this.aspect*height),up,y*height);return state.
parallel?[add(there,ahead,-this.distance),ahead]:[add(state.position,[0,0,0]),unit(subtract2(there,state.position))]}approach(height,ahead){
let distance2=Math.max(height/tangent(this.limits.view_angle),this.nearest);this.state.position=add(this.state.focal_point,
ahead,-distance2),this.state.view_angle=Math.atan(height/distance2)*360/Math.PI}focusAt(x,y){let point=this.pick?.(x,y);
if(!point)return;let ahead=this.axes[2],depth=dot2(subtract2(point,this.state.position),ahead);depth>0&&(this.state.focal_point=
add(this.state.position,ahead,depth))}shift(by){this.state.focal_point=add(this.state.focal_point,by),this.state.position=
add(this.state.position,by)}};function copyOf(state){let{position,focal_point:focus,up}=state;return{...state,position:[
...position],focal_point:[...focus],up:[...up]}}function fitted(surface,limits,positions2,aspect){let{center,extent,planar,
frame}=surface,half=tangent(limits.view_angle),back=planar?fromFrame(frame,[0,0,1]):unit([1,1,1]),up=planar?fromFrame(frame,
[0,1,0]):[0,0,1],right=unit(cross2(up,back)),rows=[right,cross2(back,right),back].map(row2=>toFrame(frame,row2)),[low,high]=[
[1/0,1/0],[-1/0,-1/0]],distance2=0;for(let n=0;n<positions2.length;n+=3){let node=[positions2[n],positions2[n+1],positions2[n+
2]];if(!Number.isFinite(node[0]))continue;let[x,y,z]=rows.map(row2=>dot2(row2,node));[x,y].forEach((value,k)=>{low[k]=Math.
min(low[k],value),high[k]=Math.max(high[k],value)});let wide=Math.max(Math.abs(x)/aspect,Math.abs(y));distance2=Math.max(
distance2,z+wide/half/(1-2*limits.margin))}let tall=Math.max(high[1]-low[1],(high[0]-low[0])/aspect,1e-12*extent);return{
position:add(center,back,planar?extent:distance2),focal_point:[...center],up,parallel:planar,parallel_scale:.5*tall/(1-2*
limits.margin),view_angle:limits.view_angle}}function widened(surface,limits,state,positions2,aspect){let{center,extent,
planar}=surface,camera=copyOf(state);if(length2(subtract2(state.focal_point,center))>.001*extent)return camera;if(planar&&
state.parallel){let[high,usual,all]=[1e9,limits.aspect,aspect].map(shape2=>fitted(surface,limits,positions2,shape2).parallel_scale),
isUsual=Math.abs(state.parallel_scale/usual-1)<.001;state.parallel_scale>.98*high&&(camera.parallel_scale=isUsual?all:Math.
max(state.parallel_scale,all))}else if(!state.parallel&&state.view_angle>.9*limits.view_angle){let back=subtract2(state.
position,state.focal_point);camera.position=add(state.focal_point,back,Math.max(1,limits.aspect/aspect))}return camera}function firstLook(surface,limits,first,nodes,aspect){
return first?widened(surface,limits,first,nodes,aspect):fitted(surface,limits,nodes,aspect)}function pointInPlane({center,
frame},camera,x,y){let[start,along2]=camera.ray(x,y),normal=fromFrame(frame,[0,0,1]);return add(start,along2,dot2(subtract2(
center,start),normal)/dot2(along2,normal))}var normalOf=({frame})=>[frame[6],frame[7],frame[8]];function isSamePlace(a,b){
let near=length2(subtract2(a.center,b.center))<.1*a.extent,ratio=a.extent/b.extent,isTurned=a.planar&&dot2(normalOf(a),normalOf(
b))<LEAST_PARALLEL;return a.planar===b.planar&&!isTurned&&near&&ratio>.8&&ratio<1.25}function projection(surface,camera,anchor){
let{state,aspect}=camera,{center,extent,frame}=surface,[right,up,ahead]=camera.axes.map(axis=>toFrame(frame,axis)),local=point=>subtract2(
toFrame(frame,subtract2(point,center)),anchor),focus=local(state.focal_point),middle=scale2(anchor,-1),radius=Math.max(.51*
extent,surface.reach??0),m=new Array(16).fill(0),half=state.parallel?state.parallel_scale:tangent(state.view_angle);if([
right.map(c=>c/half/aspect),up.map(c=>c/half)].forEach((row2,k)=>{for(let n=0;n<3;n+=1)m[4*n+k]=row2[n];m[12+k]=-dot2(row2,
focus)}),state.parallel){for(let n=0;n<3;n+=1)m[4*n+2]=ahead[n]/radius;return m[14]=-dot2(ahead,middle)/radius,m[15]=1,m}
let eye=local(state.position),depth=dot2(subtract2(middle,eye),ahead),far=Math.max(depth+radius,.001*radius),near=Math.max(
depth-radius,.001*far),a=(far+near)/(far-near),b=-2*far*near/(far-near);for(let n=0;n<3;n+=1)m[4*n+2]=ahead[n]*a,m[4*n+3]=
ahead[n];return m[15]=-dot2(ahead,eye),m[14]=m[15]*a+b,m}function rays({center,frame},camera,anchor,width,height){let[right,
up]=camera.axes,{height:half,state,aspect}=camera,[x,y]=[scale2(right,2*half*aspect/width),scale2(up,2*half/height)],corner=add(
add(subtract2(state.focal_point,center),x,-width/2),y,-height/2);return{u_rayCorner:subtract2(toFrame(frame,corner),anchor),
u_rayX:toFrame(frame,x),u_rayY:toFrame(frame,y)}}var PIXEL_COST=8,DRAFT_SAMPLES=9,COARSEST_SCALE=.2,DRAFT_SPACING=1.4,MOVING_MS=55,PLAYING_MS=125,CLEAR_SCALE=.5,FEWEST_ROWS=4,
FIRST_PRICE_MS=4e-5,CARD_PRICE_MS=2e-6;function quality(price,fixed,pixels,samples,budget){let room=Math.max(budget-fixed,
Math.min(fixed/2,budget),2)/price;if(pixels*(samples+PIXEL_COST)<=room)return{scale:1,samples};let fewer=Math.min(DRAFT_SAMPLES,
samples),scale3=Math.sqrt(room/(fewer+PIXEL_COST)/pixels);return scale3<1?{scale:Math.max(scale3,COARSEST_SCALE),samples:fewer}:
{scale:1,samples:clamp(Math.floor(room/pixels-PIXEL_COST),fewer,samples)}}function movingTime(price,fixed,pixels,samples,isPlaying){
if(!isPlaying)return MOVING_MS;let fewer=Math.min(DRAFT_SAMPLES,samples),clear=fixed+price*pixels*CLEAR_SCALE**2*(fewer+
PIXEL_COST);return clamp(clear,MOVING_MS,PLAYING_MS)}function rowsIn(budget,price,width,samples){return Math.max(Math.floor(
budget/(price*width*(samples+PIXEL_COST))),FEWEST_ROWS)}function motionFactor(samples){return(2*samples+PIXEL_COST)/(samples+
PIXEL_COST)}function learnedPrice(price,spent,pixels,samples,factor){let latest=Math.max(spent,.05)/(pixels*(samples+PIXEL_COST)*
factor);return price+(latest-price)*(latest>price?.7:.3)}function draftUniforms(settings,samples,density){let[grain,spacing,
all]=[settings.grain,settings.spacing,settings.samples].map(Number),drawn=Math.max(grain*density,Math.min(grain,1)),stretched=all*
spacing*grain*density/(samples*drawn);return{u_grain:drawn,u_spacing:clamp(stretched,.1,Math.max(DRAFT_SPACING,spacing))}}var PREAMBLE=`#version 300 es
precision highp float;
precision highp int;
`,ATTRIBUTES=["flowtexPosition","flowtexCoordinate","flowtexNormal","flowtexScalar","flowtexCorners","flowtexRadius"],SAMPLERS=[
"u_slices","u_slicesNext","u_image","u_stepImage","u_cmap","u_shares","u_along","u_nodes","u_corners","u_open","u_places",
"u_depths","u_colours","u_strides","u_below","u_texture","u_source","u_means"],Programs=class{graphics;entries=new Map;parallel=null;constructor(graphics){
this.graphics=graphics}findFeatures(){this.parallel=this.graphics.context.getExtension("KHR_parallel_shader_compile")}clear(){
this.entries.clear()}dispose(){for(let entry of this.entries.values()){for(let shader of entry.shaders)this.graphics.free(
"Shader",shader);this.graphics.free("Program",entry.program)}this.clear()}get(vertex,fragment,...defines){let key=[vertex,
fragment,...defines].join("\0"),entry=this.entries.get(key);return entry||this.entries.set(key,entry=this.build(vertex,fragment,
defines)),!entry.ready&&!entry.error&&this.finish(entry),entry}build(vertex,fragment,defines){let{graphics}=this,gl=graphics.
context,program=graphics.counted(gl.createProgram()),kinds=[gl.VERTEX_SHADER,gl.FRAGMENT_SHADER],preamble=PREAMBLE+defines.
map(name=>`#define ${name}
`).join(""),shaders=[vertex,fragment].map((source,n)=>{let shader=graphics.counted(gl.createShader(kinds[n]));return gl.
shaderSource(shader,source.startsWith("#version")?source:preamble+source),gl.compileShader(shader),gl.attachShader(program,
shader),shader});return ATTRIBUTES.forEach((name,n)=>gl.bindAttribLocation(program,n,name)),gl.linkProgram(program),{program,
shaders,uniforms:new Map,...{ready:!1,error:"",warm:!1,price:FIRST_PRICE_MS}}}finish(entry){let gl=this.graphics.context,
{program}=entry,done=this.parallel?.COMPLETION_STATUS_KHR;if(done&&!gl.getProgramParameter(program,done))return;if(!gl.getProgramParameter(
program,gl.LINK_STATUS)){if(gl.isContextLost())return;let log=[...entry.shaders.map(shader=>gl.getShaderInfoLog(shader)),
gl.getProgramInfoLog(program)].filter(Boolean).join(`
`);entry.error=log||"the driver gave no reason";return}for(let shader of entry.shaders)this.graphics.free("Shader",shader);
entry.shaders=[];let count2=gl.getProgramParameter(program,gl.ACTIVE_UNIFORMS);for(let n=0;n<count2;n+=1){let info=gl.getActiveUniform(
program,n),location=info&&gl.getUniformLocation(program,info.name);!info||!location||entry.uniforms.set(info.name.replace(
/\[0\]$/,""),{location,type:info.type})}gl.useProgram(program),SAMPLERS.forEach((name,n)=>{let sampler=entry.uniforms.get(
name),isVector=sampler?.type===gl.FLOAT_VEC2||sampler?.type===gl.INT_VEC2;sampler&&!isVector&&gl.uniform1i(sampler.location,
n)}),entry.ready=!0}use(entry,values){let gl=this.graphics.context;gl.useProgram(entry.program);for(let[name,value]of Object.
entries(values)){let uniform=entry.uniforms.get(name);if(!uniform)continue;let{location,type}=uniform,numbers=typeof value==
"object"?value:[Number(value)];type===gl.FLOAT?gl.uniform1fv(location,numbers):type===gl.FLOAT_VEC2?gl.uniform2fv(location,
numbers):type===gl.FLOAT_VEC3?gl.uniform3fv(location,numbers):type===gl.FLOAT_VEC4?gl.uniform4fv(location,numbers):type===
gl.FLOAT_MAT4?gl.uniformMatrix4fv(location,!1,numbers):type===gl.INT_VEC2?gl.uniform2iv(location,numbers):gl.uniform1i(location,
numbers[0])}}};var OUTLINE_SAMPLES=4,FRAME_MS=45,MOST_NUMBERS=[4,68],SHARED=Symbol.for("flowtex.gl/3");function drawsFloats(gl){return[
"EXT_color_buffer_float","EXT_color_buffer_half_float"].some(name=>gl.getExtension(name)!==null)}var Graphics=class{canvas=document.
createElement("canvas");gl;programs;users=new Set;waiting=new Set;common=new Map;stock=new Map;tracings=new Map;objects=0;isLost=!1;scheduled=0;picker=null;smooth=null;constructor(){
this.canvas.width=this.canvas.height=16;let gl=this.canvas.getContext("webgl2",{alpha:!0,antialias:!1,powerPreference:"h\
igh-performance"});this.gl=gl&&drawsFloats(gl)?gl:null,this.programs=new Programs(this),this.gl&&this.programs.findFeatures(),
this.canvas.addEventListener("webglcontextlost",event=>{event.preventDefault(),this.isLost=!0,this.objects=0,this.programs.
clear(),this.common.clear(),this.tracings.clear(),this.picker=this.smooth=null;for(let user of this.users)user.lost()}),
this.canvas.addEventListener("webglcontextrestored",()=>{this.isLost=!1,this.gl&&drawsFloats(this.gl)&&this.programs.findFeatures();
for(let user of this.users)user.change()})}get context(){if(!this.gl)throw new Error("WebGL2 is not available");return this.
gl}leave(user){if(this.users.delete(user),this.waiting.delete(user),!this.users.size){cancelAnimationFrame(this.scheduled),
this.scheduled=0,this.programs.dispose();for(let target of[this.picker,this.smooth])target&&this.freeTarget(target);this.
picker=this.smooth=null,this.canvas.width=this.canvas.height=16}}request(user){this.waiting.add(user),this.scheduled||=requestAnimationFrame(
now=>this.run(now))}run(now){this.scheduled=0;let until=performance.now()+FRAME_MS;for(let user of[...this.waiting])if(this.
waiting.delete(user),user.frame(now,until),performance.now()>until)break;this.waiting.size&&(this.scheduled||=requestAnimationFrame(
then=>this.run(then)))}counted(object){if(object===null)throw new Error("the graphics card has no memory left, or the co\
ntext is lost");return this.objects+=1,object}free(kind,object){if(object===null||this.isLost||!this.gl)return;this.objects-=
1,this.gl[`delete${kind}`](object)}hold(part){if(!part.digest)return part;let entry=this.stock.get(part.digest)??{part,users:0};
return this.stock.set(part.digest,{...entry,users:entry.users+1}),entry.part}release(part){let entry=part&&this.stock.get(
part.digest);!part||!entry||(entry.users-=1,entry.users||this.stock.delete(part.digest))}target(format,width,height,samples){
let gl=this.context,frame=this.counted(gl.createFramebuffer());gl.bindFramebuffer(gl.FRAMEBUFFER,frame);let buffers=[[format,
gl.COLOR_ATTACHMENT0],[gl.DEPTH_COMPONENT24,gl.DEPTH_ATTACHMENT]].map(([kind,attachment])=>{let buffer=this.counted(gl.createRenderbuffer());
return gl.bindRenderbuffer(gl.RENDERBUFFER,buffer),gl.renderbufferStorageMultisample(gl.RENDERBUFFER,samples,kind,width,
height),gl.framebufferRenderbuffer(gl.FRAMEBUFFER,attachment,gl.RENDERBUFFER,buffer),buffer});return{frame,buffers}}freeTarget(target){
this.free("Framebuffer",target.frame);for(let buffer of target.buffers)this.free("Renderbuffer",buffer)}bindSmooth(width,rows){
let gl=this.context,old=this.smooth;if(!old||old.width<width||old.height<rows){let[w,h]=[Math.max(width,old?.width??0),Math.
max(rows,old?.height??0)];old&&this.freeTarget(old);let target=this.target(gl.RGBA8,w,h,OUTLINE_SAMPLES);this.smooth={...target,
width:w,height:h}}gl.bindFramebuffer(gl.FRAMEBUFFER,this.smooth?.frame??null)}copySmooth(width,rows){let gl=this.context;
gl.bindFramebuffer(gl.READ_FRAMEBUFFER,this.smooth?.frame??null),gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER,null),gl.disable(
gl.SCISSOR_TEST),gl.blitFramebuffer(0,0,width,rows,0,0,width,rows,gl.COLOR_BUFFER_BIT,gl.NEAREST),gl.bindFramebuffer(gl.
FRAMEBUFFER,null)}numbers(draw,width=1,height=1){let gl=this.context;this.picker??=this.target(gl.RGBA32UI,...MOST_NUMBERS,
0),gl.bindFramebuffer(gl.FRAMEBUFFER,this.picker.frame),gl.viewport(0,0,width,height),gl.disable(gl.SCISSOR_TEST),gl.enable(
gl.DEPTH_TEST),gl.clearBufferuiv(gl.COLOR,0,[0,0,0,0]),gl.clear(gl.DEPTH_BUFFER_BIT),draw();let bits=new Uint32Array(4*width*
height);return gl.readPixels(0,0,width,height,gl.RGBA_INTEGER,gl.UNSIGNED_INT,bits),gl.bindFramebuffer(gl.FRAMEBUFFER,null),
bits}};function sharedGraphics(){let page=globalThis;return page[SHARED]??=new Graphics}var Poles=class{size;poles;rays;nodes;isAlongJ;cells;lines;constructor(poles,nodes,rays2){let[rows,columns]=nodes;this.poles=
poles,this.nodes=nodes,this.rays=rays2,this.isAlongJ=poles[0]?.component!==0,[this.lines,this.cells]=this.isAlongJ?[rows,
columns-1]:[columns,rows-1];let more=poles.reduce((sum,pole)=>sum+this.depth(pole)+1,0);this.size={width:columns+(this.isAlongJ?
0:more),height:rows+(this.isAlongJ?more:0)}}laidOut(own){if(!this.poles.length)return own;let[rows,columns]=this.nodes,{
width,height}=this.size,result2=new Float32Array(4*width*height);for(let j=0;j<rows;j+=1)result2.set(own.subarray(4*columns*
j,4*columns*(j+1)),4*width*j);return this.poles.forEach((pole,n)=>this.fill(result2,pole,n)),result2}fastest(texels){let most=0;
for(let line=0;line<(this.isAlongJ?this.size.height:this.size.width);line+=1){let isNear2=pole=>(line-pole.line)*pole.inward<
pole.near;if(!(line<this.lines&&this.poles.some(isNear2)))for(let k=0;k<=this.cells;k+=1){let at=this.at(line,k);most=Math.
max(most,Math.abs(texels[at]),Math.abs(texels[at+1]))}}return most}at(line,around2){return 4*(this.isAlongJ?line*this.size.
width+around2:around2*this.size.width+line)}depth({near}){return Math.min(near+3,this.lines-1)}shift(n){let before=this.
poles.slice(0,n).reduce((sum,pole)=>sum+this.depth(pole)+1,0),{inward,line}=this.poles[n];return this.lines+before-(inward>
0?line:line-this.depth(this.poles[n]))}ray(n,around2){let at=2*(n*(this.cells+1)+around2);return[this.rays[at],this.rays[at+
1]]}fill(texels,pole,n){let{cells}=this,{line,inward,component}=pole,[shift,still]=[this.shift(n),this.still(texels,pole,
n)];for(let depth=0;depth<=this.depth(pole);depth+=1)for(let k=0;k<=cells;k+=1){let from=this.at(line+inward*depth,k),to=this.
at(line+inward*depth+shift,k),[around2,across]=[texels[from+1-component],texels[from+component]],[ray,next,last]=[k,(k+1)%
cells,(k+cells-1)%cells].map(m=>this.ray(n,m));for(let c of[0,1]){let turn=(next[c]-last[c])/2;texels[to+c]=depth?inward*
across*ray[c]+around2*depth*turn:still[c]}texels.copyWithin(to+2,from+2,from+4)}}still(texels,{line,inward,component},n){
let[a,b,c,x,y]=[0,0,0,0,0];for(let k=0;k<this.cells;k+=1){let[p,q]=this.ray(n,k),square=p*p+q*q,part=texels[this.at(line,
k)+component]*inward;[x,y]=[x+part*p,y+part*q],[a,b,c]=[a+p*p/square,b+p*q/square,c+q*q/square]}let determinant2=a*c-b*b;
return[(c*x-b*y)/determinant2,(a*y-b*x)/determinant2]}get raysSize(){return[this.cells+1,Math.max(this.poles.length,1)]}get angles(){
let{cells}=this,[width,height]=this.raysSize,result2=new Float32Array(4*width*height);return this.poles.forEach((_,n)=>{
let angles=[];for(let k=0;k<=cells;k+=1){let[p,q]=this.ray(n,k),angle=Math.atan2(q,p);for(;angle<angles[k-1];)angle+=2*Math.
PI;angles.push(angle)}angles.forEach((angle,k)=>{let turn=angles[0]+2*Math.PI*k/cells+1e-6,line=angles.findLastIndex(other=>other<=
turn);result2.set([angle,Math.hypot(...this.ray(n,k)),line],4*(n*width+k))})}),result2}get uniforms(){let numbers=this.poles.
flatMap(({line,inward,near},n)=>[line,inward,near,this.shift(n)]),planes=this.poles.flatMap(({plane})=>plane);for(;numbers.
length<8;)numbers.push(0);for(;planes.length<12;)planes.push(0);return{u_poles:numbers,u_planes:planes,u_polar:Number(this.
isAlongJ)}}};var NORMAL_MAX=32767,[NOTHING,SPEED,REACH,UNKNOWN]=[0,1,2,3],UNKNOWN_LAYER=2,UNITS=8,DIRECT_LAG=4,FLOWS_HELD=4,PASS_CELLS=64,
MOST_PARTS=64,PASS_NODES=2e4,ENDLESS=1e30,LAG_ROUNDING=1e-5;function positionOf(padded,trace,shape2){let[rows,columns]=shape2,
width=padded.shape[1],[top,left]=trace.drawn,data=new Float64Array(rows*columns*3);for(let j=0,n=0;j<rows;j+=1){let first=3*
((j+top+1)*width+left+1);for(let k=0;k<3*columns;k+=1)data[n++]=padded.data[first+k]+trace.middle[k%3]}return{data,shape:[
rows,columns,3]}}function normalOf2(padded,trace,shape2){let[rows,columns]=shape2,width=3*padded.shape[1],[top,left]=trace.
drawn,data=new Int16Array(rows*columns*3);for(let j=0,n=0;j<rows;j+=1)for(let i=0;i<columns;i+=1,n+=3){let at=width*(j+top+
1)+3*(i+left+1),along2=step=>[0,1,2].map(k=>padded.data[at+step+k]-padded.data[at-step+k]),normal=cross2(along2(3),along2(
width)),size=length2(normal)||1;for(let k=0;k<3;k+=1)data[n+k]=Math.round(normal[k]/size*NORMAL_MAX)}for(let{component,line,
inward}of trace.poles??[]){let[at,last]=component?[line-top,columns]:[line-left,rows];if(at<0||at>=(component?rows:columns))
continue;let offset=(across,around2)=>3*(component?across*columns+around2:around2*columns+across),sum=[0,0,0];for(let m=0;m<
last;m+=1)for(let k=0;k<3;k+=1)sum[k]+=data[offset(at+inward,m)+k];let size=length2(sum)||1,mean=sum.map(x=>Math.round(x/
size*NORMAL_MAX));for(let m=0;m<last;m+=1)data.set(mean,offset(at,m))}return{data,shape:[rows,columns,3]}}function flowsOf({
slices},step){let{trace,times:times2,lags}=slices;if(!trace?.pathlines||!trace.timed)return[step];let reach=lags[lags.length-
1]*trace.timed.unit,near=times2.map(time=>Math.abs(time-times2[step])<reach),isNeeded=n=>near[n]||near[n-1]||near[n+1];return[
...times2.keys()].filter(isNeeded)}function stretches({slices},step,side,from,to){let{trace,times:times2}=slices;if(!trace?.
pathlines||!trace.timed)return[{from,to,steps:[step,step],between:[0,1]}];let result2=[],{unit:unit3}=trace.timed,lagOf=n=>side*
(times2[n]-times2[step])/unit3;for(let n=step;from<to;n+=side){let isLast=!(n+side in times2),end=isLast?to:lagOf(n+side);
if(end<=from+LAG_ROUNDING*to)continue;let between3=isLast?[0,1]:[lagOf(n),end],isWhole=end>=to-LAG_ROUNDING*to;result2.push(
{from,to:isWhole?to:end,steps:[n,isLast?n:n+side],between:between3}),from=isWhole?to:end}return result2}function programsOf({
programs},header,trace){let{fullVertex,trace:path="",layers=""}=header.shaders,get=(fragment,...variant)=>{let names=variant.
filter(name=>typeof name=="string"),program=programs.get(fullVertex,fragment,...names);if(program.error)throw new Error(
`the tracer cannot be built: ${program.error}`);return program},polar=trace.poles!==void 0&&"FLOWTEX_POLES";return{follow:get(
path,polar,trace.pathlines&&"FLOWTEX_PATHLINES"),compose:trace.pathlines?null:get(path,polar,"FLOWTEX_COMPOSED"),slopes:get(
layers,"FLOWTEX_SLOPES"),tangents:get(layers,polar)}}var Tracing=class{graphics;header;trace;find;textures=new Set;frames=[];result=null;passes;flows=new Map;fastest=1;poles;constructor(graphics,header,trace,find,step){
this.graphics=graphics,this.header=header,this.trace=trace,this.find=find,this.poles=new Poles(trace.poles??[],trace.nodes,
find("rays")?.data??[]),this.passes=this.slices(step)}advance(until){if(!Object.values(programsOf(this.graphics,this.header,
this.trace)).every(program=>program?.ready??!0))return null;let gl=this.graphics.context;try{do{let{done,value}=this.passes.
next();if(gl.isContextLost())return null;if(done)return this.result=null,value}while(performance.now()<until);return null}finally{
this.unbind()}}dispose(){for(let texture of this.textures)this.graphics.free("Texture",texture);for(let frame of this.frames)
this.graphics.free("Framebuffer",frame);this.result&&!this.graphics.context.isContextLost()&&this.graphics.context.deleteTexture(
this.result),this.result=null,this.textures.clear(),this.frames.length=0}data(name){let part=this.find(name);if(!part)throw new Error(
`the part "${name}" of the scene is missing`);return part.data}numbers(name){let data=this.data(name);return data instanceof
Float32Array?data:new Float32Array(data).map(bits=>HALVES[bits])}texture(width,height,inner,data){let gl=this.graphics.context,
texture=this.graphics.counted(gl.createTexture());return this.textures.add(texture),gl.activeTexture(gl.TEXTURE0),gl.bindTexture(
gl.TEXTURE_2D,texture),gl.texStorage2D(gl.TEXTURE_2D,1,inner,width,height),gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_MIN_FILTER,
gl.NEAREST),gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_MAG_FILTER,gl.NEAREST),data&&gl.texSubImage2D(gl.TEXTURE_2D,0,0,0,
width,height,gl.RGBA,gl.FLOAT,data),texture}frame(){let gl=this.graphics.context,frame=this.graphics.counted(gl.createFramebuffer());
return this.frames.push(frame),gl.bindFramebuffer(gl.FRAMEBUFFER,frame),frame}target(width,height){let gl=this.graphics.
context,texture=this.texture(width,height,gl.RGBA32UI,null),frame=this.frame();return gl.framebufferTexture2D(gl.FRAMEBUFFER,
gl.COLOR_ATTACHMENT0,gl.TEXTURE_2D,texture,0),[texture,frame]}unbind(){let gl=this.graphics.context;for(let n=0;n<UNITS;n+=
1)gl.activeTexture(gl.TEXTURE0+n),gl.bindTexture(gl.TEXTURE_2D,null),gl.bindTexture(gl.TEXTURE_2D_ARRAY,null);gl.bindFramebuffer(
gl.FRAMEBUFFER,null)}flow(step){let{trace}=this,data=this.numbers(`flow/${step}`),unit3=this.data("unit"),channels=data.
length/unit3.length,flow=new Float32Array(4*unit3.length);for(let n=0,at=0;n<unit3.length;n+=1,at+=channels){let speed=data[at+
2],size=HALVES[unit3[n]]*trace.unit;flow[4*n]=data[at]*speed/size,flow[4*n+1]=data[at+1]*speed/size,flow[4*n+2]=speed,flow[4*
n+3]=trace.timed?trace.timed.unit:size}let result2=this.poles.laidOut(flow);return trace.timed&&(this.fastest=Math.max(this.
fastest,this.poles.fastest(result2)*trace.timed.speed*trace.timed.unit)),result2}wholeSpeed(step){let data=this.numbers(
`flow/${step}`),nodes=this.data("unit").length,channels=data.length/nodes,unknown=Number(this.trace.uncertain??!1),whole=new Float32Array(
4*nodes);for(let n=0;n<nodes;n+=1)whole[4*n]=data[(n+1)*channels-1-unknown],whole[4*n+1]=unknown*data[(n+1)*channels-1];
return whole}cells(){let[rows,columns]=this.trace.nodes,[open,nearest3]=["open","nearest"].map(name=>this.find(name)?.data),
cells=new Float32Array(4*rows*columns);for(let n=0;n<rows*columns;n+=1){cells[4*n]=open?open[n]:1;for(let k of[0,1])cells[4*
n+1+k]=nearest3?nearest3[2*n+k]:0}return cells}padded(){let data=this.data("padded"),result2=new Float32Array(data.length/
3*4);for(let n=0;n<data.length/3;n+=1)for(let k=0;k<3;k+=1)result2[4*n+k]=data[3*n+k];return result2}flowTexture(step){let{
width,height}=this.poles.size,gl=this.graphics.context,texture=this.flows.get(step)??this.texture(width,height,gl.RGBA32F,
this.flow(step));this.flows.delete(step),this.flows.set(step,texture);for(let[other,old]of this.flows){if(this.flows.size<=
FLOWS_HELD)break;this.flows.delete(other),this.textures.delete(old),this.graphics.free("Texture",old)}return texture}partsOf({
from,to}){let count2=clamp(Math.ceil((to-from)*this.fastest/PASS_CELLS),1,MOST_PARTS),at=n=>n===count2?to:from+(to-from)*
n/count2;return Array.from({length:count2},(_,n)=>[at(n),at(n+1)])}*slices(step){let{graphics,trace,header}=this,gl=graphics.
context,{geometry,slices}=header,[rows,columns]=trace.nodes,[height,width]=[geometry.rows.size,geometry.columns.size],size={
width,height,layers:slices.count,channels:4,levels:geometry.levels},result2=gl.createTexture();this.result=result2,gl.activeTexture(
gl.TEXTURE0),makeLayers(gl,result2,size);let{poles}=this,own=this.texture(poles.size.width,poles.size.height,gl.RGBA32F,
this.flow(step)),rays2=this.texture(...poles.raysSize,gl.RGBA32F,poles.angles),constant=[this.texture(columns,rows,gl.RGBA32F,
this.cells()),this.texture(columns+2,rows+2,gl.RGBA32F,this.padded()),this.texture(columns,rows,gl.RGBA32F,this.wholeSpeed(
step))],pool=[0,1,2,3,4].map(()=>this.target(columns,rows)),{lags,sides,count:count2}=slices,uniforms2={u_flow:0,u_cells:1,
u_padded:2,u_speed:3,u_before:4,u_last:5,u_earlier:5,u_flowNext:6,u_rays:7,...poles.uniforms,u_longest:trace.longest??ENDLESS,
u_nodes:[columns,rows],u_closed:[Number(trace.closed[1]),Number(trace.closed[0])],u_first:[trace.first[1],trace.first[0]],
u_texels:[width,height],u_offsetJ:trace.offset.slice(0,3),u_offsetI:trace.offset.slice(3,6),u_timed:trace.timed?.speed??
0,u_rest:trace.rest,u_pace:trace.pace,u_unit:slices.unit,u_cell:slices.cell/slices.unit,u_planar:Number(geometry.planar),
u_mostReach:2*lags[lags.length-1]},draw=([w,h],textures,pass,values)=>{gl.viewport(0,0,w,h);for(let ability of[gl.SCISSOR_TEST,
gl.DEPTH_TEST,gl.BLEND,gl.CULL_FACE])gl.disable(ability);textures.forEach((texture,n)=>{gl.activeTexture(gl.TEXTURE0+n),
gl.bindTexture(gl.TEXTURE_2D,texture)}),gl.bindVertexArray(null),graphics.programs.use(pass,{...uniforms2,...values}),gl.
drawArrays(gl.TRIANGLES,0,3)},frame=this.frame(),layer=(n,pass,textures,values)=>{gl.bindFramebuffer(gl.FRAMEBUFFER,frame),
gl.framebufferTextureLayer(gl.FRAMEBUFFER,gl.COLOR_ATTACHMENT0,result2,0,n),draw([width,height],[own,...constant,...textures],
pass,values)},{follow,compose,slopes,tangents}=programsOf(graphics,header,trace);layer(0,tangents,[],{u_inCells:0}),count2>
1+sides*lags.length&&layer(count2-1,tangents,[],{u_inCells:1});let asked=0;for(let side=0;side<sides;side+=1){let sign=side?
1:-1,start=1+side*lags.length,[first,before,now]=[pool[0],pool[0],pool[0]];for(let[m,lag]of lags.entries()){let[from,earlier]=[
lags[m-1]??0,lags[m-2]??0],composer=lag>DIRECT_LAG&&earlier>0?compose:null,at=now;for(let stretch of stretches(header,step,
sign,from,lag)){let[near,far]=stretch.steps.map(n=>this.flowTexture(n)),parts=composer?[[from,lag]]:this.partsOf(stretch);
for(let[begin,end]of parts){let next=pool.find(each=>![first,before,now,at].includes(each))??pool[0];gl.bindFramebuffer(
gl.FRAMEBUFFER,next[1]),draw([columns,rows],[near,...constant,at[0],before[0],far,rays2],composer??follow,{u_lagEarlier:earlier,
u_from:begin,u_to:end,u_side:sign,u_between:stretch.between}),at=next,!((asked+=rows*columns)<PASS_NODES)&&(gl.readPixels(
0,0,1,1,gl.RGBA_INTEGER,gl.UNSIGNED_INT,new Uint32Array(4)),asked=0,yield)}}[before,now]=[now,at],m||(first=now);let isUnknown=trace.
uncertain&&m===UNKNOWN_LAYER,fourth=m===1&&!side?SPEED:isUnknown?UNKNOWN:NOTHING;m&&layer(start+m,slopes,[now[0],now[0]],
{u_fourth:fourth,u_lag:sign*lag})}layer(start,slopes,[first[0],now[0]],{u_fourth:REACH,u_lag:sign*lags[0]})}return gl.activeTexture(
gl.TEXTURE0),gl.bindTexture(gl.TEXTURE_2D_ARRAY,result2),size.levels&&gl.generateMipmap(gl.TEXTURE_2D_ARRAY),result2}};var STEPS_HELD={slices:[12,4],flow:[100,24]},MARKS_HELD=24,HeldParts=class{all=new Map;graphics;constructor(graphics){this.
graphics=graphics}set(part){let{name,digest}=part;if(digest&&this.all.get(name)?.digest===digest)return!1;let held=this.
graphics.hold(part);return this.remove(name),this.all.set(name,held),!0}remove(name){this.graphics.release(this.all.get(
name)),this.all.delete(name)}clear(isGone=()=>!0){for(let name of[...this.all.keys()])isGone(name)&&this.remove(name)}trim(header,source,shown){
let{hasSteps=!1,hasMarks=!1,memory=0}=source??{};if(!header||!hasSteps)return;for(let kind2 of hasMarks?Object.keys(MARKS):
[]){let held=[...this.all.keys()].filter(name=>name.startsWith(`${kind2}/`));for(let name of held.slice(0,-MARKS_HELD))shown.
includes(stepOf(name))||this.remove(name)}let kind=header.slices.trace?"flow":"slices",named=some=>[...this.all.keys()].
filter(name=>name.startsWith(some)),needed=shown.flatMap(step=>flowsOf(header,step));for(let name of named(`${kind}/`).slice(
0,-STEPS_HELD[kind][+(memory>0)])){let step=stepOf(name);if(needed.includes(step))continue;for(let held of[kind,"extra"])
this.remove(`${held}/${step}`);let values=memory?named("scalars/"):[];for(let other of values)isOfStep(other,step,header)&&
this.remove(other)}}};var Lifetime=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(target,kind,call,options={}){(target===document||target===window)&&(this.globalListeners+=
1);let{signal}=this.controller;target.addEventListener(kind,call,{...options,signal})}later(call,delay){let timer=setTimeout(
()=>{this.timers.delete(timer),call()},delay);return this.timers.add(timer),timer}cancel(timer){timer!==null&&(clearTimeout(
timer),this.timers.delete(timer))}observe(observer,element){observer.observe(element),this.observers.add(observer)}watch(observer,element,what){
observer.observe(element,what),this.observers.add(observer)}stats(){let{globalListeners:listeners,observers,timers}=this;
return{listeners,observers:observers.size,timers:timers.size}}end(){this.controller.abort(),this.globalListeners=0;for(let observer of this.
observers)observer.disconnect();this.observers.clear();for(let timer of this.timers)clearTimeout(timer);this.timers.clear()}};
function throttled(later,wait,call){let next=null,running=!1,run=()=>{if(running=next!==null,!next)return;let{value}=next;
next=null,call(value),later(run,wait)};return value=>{next={value},running||run()}}function uniforms(header,settings,view){let{geometry,slices,constants}=header,s=settings,signFree=isSignFree(header),finest=2**
(Math.floor(Math.log2(geometry.extent))-constants.noiseDoublings),w=view.eye[3],eye=toFrame(geometry.frame,subtract2(view.
eye,scale2(geometry.center,w))),sparse=isSparse(header,settings),chosen=sparse?"ramp":s.kernel,kernel=signFree&&chosen===
"ramp"?"hann":chosen;return{u_eye:[...subtract2(eye,scale2(view.anchor,w)),w],u_between:view.between,u_slicesSize:[geometry.
columns.size,geometry.rows.size],u_deepest:geometry.levels,u_lags:slices.lags,u_lagCount:slices.lags.length,u_sides:s.two_sided||
signFree||sparse?slices.sides:1,u_unit:slices.unit,u_rateLayer:slices.count-1,u_cell:slices.cell,u_samples:isMoving(header,
settings,view.still)?2*s.samples-1:s.samples,u_spacing:s.spacing,u_grain:s.grain*view.density,u_kernel:constants.kernels.
indexOf(kernel),u_lod:s.lod,u_contrast:s.contrast,u_strength:s.strength,u_even:isEven(header,settings),u_fade:signFree?0:
s.fade,u_seed:s.seed,u_showLevel:s.show_level,u_fixed:s.fixed_grain,...motionUniforms(header,s,view),...noiseOrigin(header,
view,finest),...turnUniforms(header,view,finest),u_noiseFinest:finest,u_texel:geometry.extent/s.resolution,u_apart:arrowDistance(
header,settings)*view.density,u_bySpeed:settings.arrow_length==="speed",u_arrowSides:slices.sides,u_pieces:constants.arrows.
pieces,...header.image?imageUniforms(header.image,s,view.density):{}}}function isMoving(header,settings,still=!1){let streams=settings.
motion!=="off"&&!isSignFree(header);return!header.image&&(streams||header.slices.steps>1&&!still)}function isSparse(header,settings){
return!header.image&&settings.texture==="streaklets"}function isEven(header,settings){return!!(settings.lod&&!settings.fixed_grain)&&
!header.image&&!isSparse(header,settings)}function hasArrows(header,settings){return Number(settings.arrows)>0&&!isSignFree(
header)&&!header.image}function arrowDistance({constants},{arrows}){return constants.arrows.least*Math.max(Number(arrows),
constants.arrows.mostDense)}function isNear(header,settings,view){let{geometry,slices,constants}=header,s=settings,gap=Math.
hypot(...subtract2(view.eye,geometry.center))-.5*geometry.extent,away=view.eye[3]?Math.max(gap,0)/Math.hypot(...subtract2(
view.eye,view.focus)):1,grain=s.lod?view.pixel*away*s.grain*view.density:geometry.extent/s.resolution;return Math.floor(
s.samples/2)*s.spacing*grain<constants.farCells*slices.critical}function variantOf(header,settings,isClose,still){let chosen={
FLOWTEX_CELLS:isClose,FLOWTEX_MOVING:isMoving(header,settings,still),FLOWTEX_SPARSE:isSparse(header,settings),FLOWTEX_REPEATED:!!header.
ends};return Object.entries(chosen).flatMap(([name,holds])=>holds?[name]:[])}function motionUniforms(header,s,view){let{
geometry,constants}=header,{times:times2,pace}=header.slices,varies=times2.length>1,inPixels=!varies&&s.speed_in==="pixe\
ls",span=times2[times2.length-1]-times2[0],rounds=span*pace/geometry.extent,period=varies?span/(Math.round(rounds)||rounds):
s.period,turns=(varies?view.time-times2[0]:view.clock)/period%constants.mostTurns,travel=period*(varies?pace:s.speed),fine=turns%
constants.clockStep;return{u_clock:[turns-fine,fine],u_travel:travel*(inPixels?view.density:1),u_travelInPixels:inPixels,
u_travelBySpeed:varies||s.motion==="speed",u_wave:constants.wavePixels*view.density}}function noiseOrigin(header,view,finest){
let{noiseDoublings,clearDoublings}=header.constants,{frame,center}=header.geometry,focus=toFrame(frame,subtract2(view.focus,
center)),limit=2**(noiseDoublings-clearDoublings)-1,cells=2**clearDoublings,even=focus.map(x=>clamp(Math.round(x/finest/
cells),-limit,limit)*cells),odd=even.map(x=>x/Math.SQRT2),whole=odd.map(x=>Math.floor(x/cells)*cells);return{u_noiseOrigin:even.
map((x,k)=>x*finest-view.anchor[k]),u_noiseOriginEven:even,u_noiseOriginOdd:whole,u_noiseRestOdd:odd.map((x,k)=>x-whole[k])}}
function turnUniforms(header,view,finest){let{ends:ends2,geometry,constants}=header;if(!ends2)return{};let{frame,center}=geometry,
across=toFrame(frame,[1,0,0]),[low,high]=ends2.map(end=>end-center[0]-dot2(across,view.anchor)),cells=2**constants.clearDoublings,
even=scale2(across,(ends2[1]-ends2[0])/finest),odd=scale2(even,Math.SQRT1_2),wholeOf=turn=>turn.map(x=>Math.floor(x/cells)*
cells),restOf=turn=>turn.map(x=>x-Math.floor(x/cells)*cells);return{u_ends:[across[0],across[1],low,high],u_turnEven:wholeOf(
even),u_turnRestEven:restOf(even),u_turnOdd:wholeOf(odd),u_turnRestOdd:restOf(odd)}}function imageUniforms({size,stepSize,
repeat,deviations},s,density){let tiles=deviations?1:s.tiles,texels=density*(deviations?s.grain:tiles);return{u_stepSize:stepSize.
map(n=>n*density),u_imageSize:size.map(n=>n*texels),u_imageRound:[Number(repeat[1]),Number(repeat[0])],u_tiles:tiles,...deviations?
{u_noiseDeviations:deviations}:{}}}function momentOf(times2,time){if(times2.length<2)return[0,0,0];let step=0;for(;step<
times2.length-2&&times2[step+1]<=time;)step+=1;let late=(time-times2[step])/(times2[step+1]-times2[step]);return[step,step+
1,clamp(late,0,1)]}var SERIES_STEP_S=.5,SERIES_LEAST_S=6,SERIES_MOST_S=60,LONGEST_GAP_S=.5,Player=class{time=0;clock=0;playing=!1;pace=1;times=[
0];lastFrame=0;hasHeader=!1;setHeader(header){let{times:times2}=header.slices;(!(times2.length===this.times.length&&times2.
every((t,n)=>t===this.times[n]))||!this.hasHeader)&&(this.time=header.time,this.clock=header.clock),this.hasHeader=!0,this.
times=times2}get varies(){return this.times.length>1}get span(){return[this.times[0],this.times[this.times.length-1]]}get moment(){
return momentOf(this.times,this.time)}timeOf([before,after,between3]){return this.times[before]+between3*(this.times[after]-
this.times[before])}seek(time){this.time=clamp(time,...this.span)}stepFrom(count2){let{times:times2,time}=this,after=times2.
findIndex(each=>count2>0?each>time:each>=time),steps=times2.length,at=after<0?steps:after;return times2[(count2>0?at:at-
1+steps)%steps]}start(){this.playing=!0,this.lastFrame=0}range(settings){if(this.varies)return{first:this.span[0],last:this.
span[1],now:this.time};let period=Number(settings.period);return{first:0,last:period,now:this.clock%period}}advance(now,ready){
let passed=this.lastFrame?Math.min((now-this.lastFrame)/1e3,LONGEST_GAP_S)*this.pace:0;if(this.lastFrame=now,!this.varies)
return this.clock+=passed,!0;let[first,last]=this.span,series=clamp(SERIES_STEP_S*(this.times.length-1),SERIES_LEAST_S,SERIES_MOST_S),
next=this.time+passed*(last-first)/series,[before,after]=momentOf(this.times,Math.min(next,last));return ready([before,after])?
(this.time=next>last?first:next,!0):!1}};var[CELLS,LEAST_CELLS]=[160,8],[NEWTON_STEPS,FAR]=[100,3],[LAST_STEP,REMAINS,BEYOND]=[1e-6,1e-11,1e-6],[SAME,SAME_DEGENERATE]=[
1e-6,.05],[CHANGE,DEGENERATE]=[.01,1e-5],[SINGULAR,ROUNDING,REAL_SHARE]=[1e-13,1e-9,1e-6],[AROUND,ON_LINE]=[.1,.02],[RADIUS,
CIRCLE,MOST_DIRECTIONS]=[.05,720,24],[TURN_RADIUS,TURN_STEPS,RETURNED]=[2,400,1e-7],NULLCLINE_CELLS=256,[NULLCLINE_HALVINGS,
LEFT]=[12,.25],[STEPS,MOST_STEPS2,BEGIN,END]=[800,2400,.02,1.5],[LEAST_TURN,CLOSED,WOUND]=[8,.08,2],[MOST_AROUND,RATIO,APART]=[
8,1.2,.03],[MOVED,HALVINGS]=[1e-5,28],FINER=1/16,GROWTH=.001,difference=(a,b)=>[a[0]-b[0],a[1]-b[1]],along=(a,way,step)=>[
a[0]+step*way[0],a[1]+step*way[1]],distance=(a,b)=>Math.hypot(a[0]-b[0],a[1]-b[1]),larger=a=>Math.max(Math.abs(a[0]),Math.
abs(a[1])),clipped=(at,ends2)=>at.map((x,k)=>Math.min(Math.max(x,ends2[k][0]),ends2[k][1]));function fixedPoints(rate,gradient,ends2){
let sides=ends2.map(([low,high])=>high-low),counts=sides.map(side=>Math.max(Math.round(CELLS*side/Math.max(...sides)),LEAST_CELLS)),
cell=[sides[0]/counts[0],sides[1]/counts[1]],search=new Search(rate,gradient,cell),apart=(one,other)=>larger([(one[0]-other[0])/
cell[0],(one[1]-other[1])/cell[1]]),found=[];for(let{at:start,scale:scale3}of starts(rate,ends2,counts,cell)){let zero=search.
zero(start,scale3);!zero||apart(zero.at,clipped(zero.at,ends2))>BEYOND||found.push({...zero,at:clipped(zero.at,ends2),isDegenerate:search.
isDegenerate(zero.at,scale3)})}found.sort((one,two)=>Number(two.isDegenerate)-Number(one.isDegenerate)||one.left-two.left);
let kept=[];for(let zero of found)kept.every(({at,isDegenerate})=>apart(zero.at,at)>=(isDegenerate?SAME_DEGENERATE:SAME))&&
kept.push(zero);let isOnLine=({at,scale:scale3,isDegenerate})=>isDegenerate&&search.sides(AROUND,at).some(near=>{let other=search.
zero(near,scale3);return other&&apart(other.at,at)>ON_LINE}),zeros2=kept.filter(zero=>!isOnLine(zero));for(let{at}of zeros2)
at.forEach((x,k)=>{Math.abs(x)<REMAINS*cell[k]&&(at[k]=0)});return zeros2.map(zero=>{let free=other=>Math.hypot((other.at[0]-
zero.at[0])/cell[0],(other.at[1]-zero.at[1])/cell[1]);return search.point(zero,Math.min(1/0,...zeros2.filter(other=>other!==
zero).map(free)))}).sort((one,two)=>two.steepness-one.steepness)}function starts(rate,[xs,ys],[columns,rows],cell){let nodes=[
0,1].map(()=>new Float64Array((columns+1)*(rows+1)));for(let n=0;n<nodes[0].length;n+=1)rate(xs[0]+cell[0]*(n%(columns+1)),
ys[0]+cell[1]*Math.floor(n/(columns+1))).forEach((value,k)=>nodes[k][n]=Number.isFinite(value)?value:NaN);let found=[];for(let j=0;j<
rows;j+=1)for(let i=0;i<columns;i+=1){let scale3=[0,0],isChosen=!0;for(let k=0;k<2&&isChosen;k+=1){let least=1/0,top=-1/0,
bottom=1/0;for(let row2=Math.max(j-1,0);row2<=Math.min(j+2,rows);row2+=1)for(let column=Math.max(i-1,0);column<=Math.min(
i+2,columns);column+=1){let value=nodes[k][row2*(columns+1)+column];if(Number.isNaN(value))continue;value>top&&(top=value),
value<bottom&&(bottom=value),(row2===j||row2===j+1)&&(column===i||column===i+1)&&Math.abs(value)<least&&(least=Math.abs(
value))}scale3[k]=Math.max(Math.abs(top),Math.abs(bottom)),isChosen=scale3[k]<1/0&&least<=top-bottom}!isChosen||!(larger(
scale3)>0)||found.push({at:[xs[0]+cell[0]*(i+.5),ys[0]+cell[1]*(j+.5)],scale:[scale3[0]||1,scale3[1]||1]})}return found}
var Search=class{rate;gradient;cell;constructor(rate,gradient,cell){[this.rate,this.gradient,this.cell]=[rate,gradient,cell]}sides(cells,at){
let{cell}=this;return[[1,0],[1,1],[0,1],[-1,1],[-1,0],[-1,-1],[0,-1],[1,-1]].map(([x,y])=>[at[0]+cells*cell[0]*x,at[1]+cells*
cell[1]*y])}matrix(at,scale3){return this.gradient(...at).map((value,n)=>value*this.cell[n%2]/scale3[n>>1])}step(at,scale3){
let[u,v2]=this.rate(...at).map((value,k)=>value/scale3[k]),[a,b,c,d]=this.matrix(at,scale3),[size,determinant2]=[a*a+b*b+
c*c+d*d,a*d-b*c],share=Math.abs(determinant2)/size,step=share>.1*SINGULAR?[(b*v2-d*u)/determinant2,(c*u-a*v2)/determinant2]:
[-(a*u+c*v2)/size,-(b*u+d*v2)/size];return{left:larger([u,v2]),step,share}}zero(start,scale3){let{cell}=this,[at,best,least]=[
start,start,1/0];for(let n=0;n<NEWTON_STEPS;n+=1){let{left:left2,step:step2}=this.step(at,scale3);left2<least&&([best,least]=
[at,left2]);let length3=larger(step2),share2=1/Math.max(length3,1);if(at=[at[0]+cell[0]*step2[0]*share2,at[1]+cell[1]*step2[1]*
share2],!at.every((x,k)=>Math.abs(x-start[k])<=FAR*cell[k])||!(length3>SINGULAR))break}let{left,step,share}=this.step(best,
scale3);return left<=REMAINS||larger(step)<LAST_STEP&&share>SINGULAR?{at:best,scale:scale3,left}:null}isDegenerate(at,scale3){
let[here,...near]=[at,...this.sides(CHANGE,at)].map(place=>{let[a,b,c,d]=this.matrix(place,scale3);return{determinant:a*
d-b*c,size:a*a+b*b+c*c+d*d}}),changes=near.map(({determinant:determinant3})=>Math.abs(determinant3-here.determinant)).filter(
Number.isFinite),determinant2=Math.abs(here.determinant);return!(determinant2>SINGULAR*here.size&&determinant2*CHANGE>=DEGENERATE*
Math.max(0,...changes))}point({at,isDegenerate},free){let[a,b,c,d]=this.gradient(...at),[trace,determinant2]=[a+d,a*d-b*
c],[square,size]=[trace**2/4-determinant2,Math.max(...[a,b,c,d].map(Math.abs))],root=Math.sqrt(Math.abs(square)),eigenvalues=square>
0?[[trace/2+root,0],[trace/2-root,0]]:[[trace/2,root],[trace/2,-root]],result2={at,eigenvalues,steepness:Math.abs(determinant2),
ways:[],kind:"degenerate",index:Math.sign(determinant2)};if(isDegenerate)return{...result2,index:this.turns(at,Math.min(
RADIUS,.3*free)),ways:this.directions(at)};if(determinant2<0){let way=value=>{let[one,two]=[[b,value-a],[value-d,c]],[x,
y]=Math.hypot(...one)>Math.hypot(...two)?one:two;return[x/Math.hypot(x,y),y/Math.hypot(x,y)]},ways=[root,-root].flatMap(
part=>{let[x,y]=way(trace/2+part);return[[x,y],[-x,-y]].map(each=>({way:each,leaves:part>0}))});return{...result2,kind:"\
saddle",ways}}if(!(square<0&&root>REAL_SHARE*Math.sqrt(determinant2)))return{...result2,kind:trace>0?"source":"sink"};let growth=Math.
abs(trace)<=ROUNDING*size?this.growth(at,[a,b,c,d],Math.min(TURN_RADIUS,.2*free)):trace;return{...result2,kind:growth>0?
"spiral source":growth<0?"spiral sink":"centre"}}turns(at,radius){let angles=circle().map(angle=>{let[u,v2]=this.rate(at[0]+
radius*this.cell[0]*Math.cos(angle),at[1]+radius*this.cell[1]*Math.sin(angle));return Math.atan2(v2,u)}),turned2=angles.
slice(1).reduce((sum,angle,n)=>sum+folded(angle-angles[n]),0);return Math.round(turned2/(2*Math.PI))||0}directions(at){let radius=RADIUS*
Math.max(...this.cell),wayOf=angle=>[Math.cos(angle),Math.sin(angle)],radial=angle=>{let way=wayOf(angle),[u,v2]=this.rate(
...along(at,way,radius));return{across:way[0]*v2-way[1]*u,out:way[0]*u+way[1]*v2}},angles=circle(),across=angles.map(angle=>radial(
angle).across),found=angles.flatMap((low,n)=>{if(!(across[n]*across[n+1]<0))return[];let high=angles[n+1];for(let k=0;k<
50;k+=1){let middle=.5*(low+high);radial(middle).across*across[n]>0?low=middle:high=middle}return[{way:wayOf(low),leaves:radial(
low).out>0}]});return found.length>MOST_DIRECTIONS?[]:found.filter(({leaves},n)=>[-1,1].some(m=>found.at((n+m)%found.length)?.
leaves!==leaves))}growth(at,[a,b,c],cells){let turn=Math.sqrt(-a*a-b*c),radius=cells/Math.max(1/this.cell[0],(turn+Math.
abs(a))/Math.abs(b)/this.cell[1]),rate=(x,y)=>{let[u,v2]=this.rate(at[0]+x,at[1]+(turn*y-a*x)/b);return[u,(a*u+b*v2)/turn]},
w=[radius,0];for(let n=0;n<TURN_STEPS+4;n+=1)w=stepped(rate,w,n<TURN_STEPS?2*Math.PI/TURN_STEPS/turn:w[1]/(turn*w[0]));let growth=w[0]/
radius-1;return Math.abs(growth)>RETURNED?growth:0}},folded=angle=>angle-2*Math.PI*Math.round(angle/(2*Math.PI));function circle(){
return Array.from({length:CIRCLE+1},(_,n)=>.3+2*Math.PI*n/CIRCLE)}function stepped(rate,at,step){let one=rate(...at),two=rate(
...along(at,one,step/2)),three=rate(...along(at,two,step/2)),four=rate(...along(at,three,step)),sum=k=>(one[k]+2*two[k]+
2*three[k]+four[k])/6;return along(at,[sum(0),sum(1)],step)}function nullclines(rate,ends2,window2=null){let coarse=piecesIn(
rate,ends2);if(!window2)return coarse;let isOutside=([one,two])=>window2.some(([low,high],k)=>Math.abs(one[k]+two[k]-low-
high)>high-low),fine=piecesIn(rate,window2);return coarse.map((pieces,k)=>[...pieces.filter(isOutside),...fine[k]])}function piecesIn(rate,[
xs,ys]){let sides=[xs[1]-xs[0],ys[1]-ys[0]],[columns,rows]=sides.map(side=>Math.max(Math.round(NULLCLINE_CELLS*side/Math.
max(...sides)),8)),nodes=Array.from({length:(rows+1)*(columns+1)},(_,n)=>{let at=[xs[0]+sides[0]*(n%(columns+1))/columns,
ys[0]+sides[1]*Math.floor(n/(columns+1))/rows];return{at,value:rate(...at)}});return[0,1].map(k=>{let pieces=[];for(let n=0;n<
rows*columns;n+=1){let low=n+Math.floor(n/columns),[a,b,c,d]=[low,low+1,low+columns+1,low+columns+2].map(node=>nodes[node]);
for(let corners of[[a,b,d],[a,d,c]]){let isSide=corners.filter(({value})=>value[k]!==0).length===1,above=corners.map(({value})=>isSide?
value[k]!==0:value[k]>0),alone=above.findIndex((one2,m)=>one2!==above[(m+1)%3]&&one2!==above[(m+2)%3]);if(alone<0||!corners.
every(({value})=>Number.isFinite(value[k])))continue;let one=corners[alone],[start,end]=[1,2].map(m=>crossing(at=>rate(...at)[k],
one.at,corners[(alone+m)%3].at));start&&end&&pieces.push([start,end])}}return pieces})}function crossing(rate,one,two){let size=()=>Math.
max(Math.abs(rate(one)),Math.abs(rate(two))),[first,isAbove]=[size(),rate(one)>0];for(let n=0;n<NULLCLINE_HALVINGS;n+=1){
let middle=along(one,difference(two,one),.5);rate(middle)>0===isAbove?one=middle:two=middle}let share=rate(one)/(rate(one)-
rate(two));return size()<LEFT*first?along(one,difference(two,one),Number.isFinite(share)?share:.5):null}function separatrices(rate,gradient,ends2,points,saddles){
let step=Math.hypot(...ends2.map(([low,high])=>high-low))/STEPS;return saddles.flatMap(saddle=>saddle.ways.map(({way,leaves})=>{
let begin=along(saddle.at,way,BEGIN*step),path=followed(rate,ends2,points,[saddle.at,begin],leaves?step:-step),closed=turnOf(
path,step,CLOSED),turn=closed&&path.slice(closed[0],closed[1]+1),ended=points.some(({at})=>at===path[path.length-1]),wound=turnOf(
path,step,WOUND);return{path:wound?path.slice(0,2*wound[1]-wound[0]+1):path,saddle,leaves,orbit:turn&&!ended&&isIsolated(
rate,gradient,turn)?turn:null}}))}function isIsolated(rate,gradient,turn){let growth=0;for(let n=1;n<turn.length;n+=1){let[
a,,,d]=gradient(...turn[n]);growth+=(a+d)*distance(turn[n],turn[n-1])/Math.hypot(...rate(...turn[n]))}return Math.abs(growth)>
GROWTH}function closedOrbits(rate,ends2,points){let diagonal=Math.hypot(...ends2.map(([low,high])=>high-low)),step=diagonal/
STEPS,found=[];for(let{at:[x,y]}of points.filter(({index})=>index>0).slice(0,MOST_AROUND)){let turn=(place,way)=>{let length3=Math.
min(step,FINER*place),side=Math.sign(way*rate(x+place,y)[1]),isBack=path2=>{if(path2.length<=LEAST_TURN)return!1;let before2=path2[path2.
length-2],after2=path2[path2.length-1];return side*(before2[1]-y)<0&&side*(after2[1]-y)>=0&&after2[0]>x},path=followed(rate,
ends2,points,[[x+place,y]],way*length3,isBack);if(path.length<2||!isBack(path))return null;let[before,after]=path.slice(
-2),rest=way*length3*(y-before[1])/(after[1]-before[1]);for(let n=0;n<3;n+=1){let at=stepped(unit2(rate),before,rest);rest+=
(y-at[1])/unit2(rate)(...at)[1]}return[...path.slice(0,-1),stepped(unit2(rate),before,rest)]},moved=(place,way)=>(turn(place,
way)?.at(-1)?.[0]??NaN)-x-place,last=null;for(let place=2*step;x+place<ends2[0][1];place+=Math.min((RATIO-1)*place,APART*
diagonal)){let forward=moved(place,1),out=Number.isNaN(forward)?-moved(place,-1):forward;if(!(Math.abs(out)<=MOVED*place)){
if(last&&last.out*out<0){let way=Math.sign(last.out),[low,high]=[last.place,place];for(let n=0;n<HALVINGS;n+=1){let middle=(low+
high)/2;moved(middle,way)>0?low=middle:high=middle}let path=turn(low,way),isNew=path&&windsAround(path,[x,y])&&!found.some(
other=>other.path.some(at=>distance(at,path[0])<2*step));path&&isNew&&distance(path[0],path[path.length-1])<CLOSED*step&&
found.push({path,isStable:way>0})}last=Number.isNaN(out)?null:{place,out}}}}return found}function trajectory(rate,ends2,points,at){
let step=Math.hypot(...ends2.map(([low,high])=>high-low))/STEPS,ahead=followed(rate,ends2,points,[at],step),closed=turnOf(
ahead,step,CLOSED);return closed?ahead.slice(0,closed[1]+1):[...followed(rate,ends2,points,[at],-step).reverse(),...ahead.
slice(1)]}function windsAround(path,[x,y]){let turned2=0;for(let n=1;n<path.length;n+=1){let[[a,b],[c,d]]=[path[n-1],path[n]].
map(at=>difference(at,[x,y]));turned2+=Math.atan2(a*d-b*c,a*c+b*d)}return Math.abs(turned2)>Math.PI}function unit2(rate){
return(x,y)=>{let[u,v2]=rate(x,y),size=Math.hypot(u,v2);return[u/size,v2/size]}}function shareInside(from,to,[low,high]){
return to>high?Math.max((high-from)/(to-from),0):to<low?Math.max((low-from)/(to-from),0):1}function followed(rate,ends2,points,path,step,isEnd=()=>!1){
let near=END*Math.abs(step),direction=unit2(rate),isAway=!1;for(let n=0;n<MOST_STEPS2;n+=1){let at=path[path.length-1],next=stepped(
direction,at,step);if(!Number.isFinite(next[0])||!Number.isFinite(next[1]))return path;let share=Math.min(shareInside(at[0],
next[0],ends2[0]),shareInside(at[1],next[1],ends2[1]));if(path.push(along(at,difference(next,at),share)),share<1||isEnd(
path))return path;let end=points.find(point=>distance(point.at,next)<near);if(end&&isAway)return[...path,end.at];isAway||=
!points.some(point=>distance(point.at,next)<2*near)}return path}function turnOf(path,step,apart){let around2=Math.max(.75,
1.25*apart)*step,places=new Map,cellOf2=at=>at.map(x=>Math.floor(x/around2));for(let n=0;n<path.length;n+=1){let[i,j]=cellOf2(
path[n]);for(let m=0;m<9;m+=1)for(let before of places.get(`${i+m%3-1} ${j+Math.floor(m/3)-1}`)??[]){if(n-before<=LEAST_TURN||
distance(path[n],path[before])>around2||before+1>=path.length)continue;let way=difference(path[before+1],path[Math.max(before-
1,0)]),gap=difference(path[n],path[before]);if(Math.abs(gap[0]*way[1]-gap[1]*way[0])/Math.max(Math.hypot(...way),1e-300)<
apart*step)return[before,n]}let name=`${i} ${j}`;places.set(name,[...places.get(name)??[],n])}return null}function percentileOf(sorted,percent){let place=percent/100*(sorted.length-1),before=Math.floor(place),after=Math.min(before+
1,sorted.length-1);return sorted[before]+(place-before)*(sorted[after]-sorted[before])}function widened2([low,high],{same,
widening}){let size=Math.max(Math.abs(low),Math.abs(high));return high-low>same*size?[low,high]:size>0?[low-widening*size,
high+widening*size]:[0,1]}function rangeOf(values,rules){let sorted=values.filter(Number.isFinite).sort();if(!sorted.length)
return null;let[least,most]=widened2([sorted[0],sorted[sorted.length-1]],rules),[from,to]=rules.percentiles.map(percent=>percentileOf(
sorted,percent)),[low,high]=widened2([from,to],rules),tail=rules.tail*(high-low);return tail<rules.leastShare*(most-least)?
{low:least,high:most,least,most}:{low:low-least>tail?low:least,high:most-high>tail?high:most,least,most}}var ROOT="",PLACE=5,nameOf=key=>key.join("/"),keyOf=name=>name.split("/").map(Number);function cellPixels(pyramid,settings){
let[samples,spacing,grain]=["samples","spacing","grain"].map(s=>Number(settings[s])),streak=.5*samples*spacing*grain;return pyramid.
cellPixels*Math.max(1,2*streak/(pyramid.cellPixels*pyramid.pathCells))}var Pyramid=class{header;place;constructor(header,places){
this.header=header;let start=0,starts2=header.blocks.map(([rows,columns])=>(start+=rows*columns)-rows*columns);this.place=
typeof places=="function"?places:(level,row2,column)=>{let at=PLACE*(starts2[level]+row2*header.blocks[level][1]+column);
return places.subarray(at,at+PLACE)}}blocksOf(name,[level,row2,column]){let[rows,columns]=this.header.blocks[level];if(name===
ROOT)return[0,0,rows,columns];let{tileBlocks:size}=this.header,ends2=[Math.min(size*(row2+1),rows),Math.min(size*(column+
1),columns)];return[size*row2,size*column,...ends2]}children(name,[level,row2,column]){let{blocks,tileBlocks}=this.header,
counts=blocks[level-1].map(n=>Math.ceil(n/tileBlocks)),[from,to]=name===ROOT?[[0,0],counts]:[[2*row2,2*column],[row2,column].
map((n,k)=>Math.min(2*n+2,counts[k]))],keys=[];for(let j=from[0];j<to[0];j+=1)for(let i=from[1];i<to[1];i+=1)keys.push([
level-1,j,i]);return keys}finerPart([,row2,column],above){let{tileBlocks}=this.header,half=tileBlocks/2,[,j,i]=above===ROOT?
[0,0,0]:keyOf(above);return[half*row2-tileBlocks*j,half*column-tileBlocks*i,half]}choose(view){let chosen=new Map,{depth,
finest}=this.header,waiting=[ROOT];for(let name of waiting){let key=name===ROOT?[depth,0,0]:keyOf(name),choice={key,needed:!1,
pixels:0,finer:[]},[top,left,bottom,right]=this.blocksOf(name,key),width=this.header.blocks[key[0]][1],coarse=new Set;for(let j=top;j<
bottom;j+=1)for(let i=left;i<right;i+=1){let place=this.place(key[0],j,i);if(!isSeen(view,place)||view.shownOn?.sees(place)===
!1)continue;let pixels=cellSize(view,place)*(view.shownOn?.scale(place)??1);key[0]>finest&&pixels>view.cellPixels?coarse.
add(j*width+i):choice.needed=!0,coarse.has(j*width+i)||(choice.pixels=Math.max(choice.pixels,pixels))}coarse.size&&(choice.
finer=this.children(name,key).filter(child=>{let[row2,column,size]=this.finerPart(child,ROOT);return[...coarse].some(block=>{
let[j,i]=[Math.floor(block/width)-row2,block%width-column];return j>=0&&j<size&&i>=0&&i<size})}).map(nameOf)),chosen.set(
name,choice),waiting.push(...choice.finer)}return chosen}};function isSeen({planes},[x,y,z,radius]){return planes.every(
p=>dot2(p,[x,y,z])+p[3]>=-radius*length2(p.slice(0,3)))}function cellSize({eye,halfHeight,pixels},[x,y,z,radius,size]){let away=eye?
Math.max(length2(subtract2([x,y,z],eye))-radius,size):1;return size*.5*pixels/(halfHeight*away)}function wantedTiles(chosen){
return[...chosen].filter(([name,{needed}])=>name!==ROOT&&needed).sort(([,a],[,b])=>b.pixels-a.pixels).map(([name])=>name)}
function cover(chosen,ready){let shown=new Map,hide=name=>{shown.delete(name),chosen.get(name)?.finer.forEach(hide)},covered=name=>{
let{needed=!1,finer=[]}=chosen.get(name)??{},done=finer.filter(covered);return name!==ROOT&&!needed&&done.length===finer.
length?!0:name!==ROOT&&!ready(name)?(done.forEach(hide),!1):(shown.set(name,done),!0)};return covered(ROOT),shown}function fullIndex(place,level,nodes){
let line=n=>Math.min(n*2**level,nodes-1),low=Math.floor(place);return line(low)+(place-low)*(line(low+1)-line(low))}function levelIndex(place,level,nodes){
let step=2**level,low=Math.max(Math.min(Math.floor(place/step),Math.ceil((nodes-1)/step)-1),0);return low+(place-low*step)/
(Math.min((low+1)*step,nodes-1)-low*step)}var PARAMETER="formula.",[HALO,BEFORE]=[36,8],[LEVELS,PLACE2,HALF_ONE]=[3,5,15360],MOST_SPEED=1e30,MOST_SADDLES=50,[WINDOW_VIEWS,
WINDOW_STEPS]=[2,4],OPERATIONS=new Map(Object.entries({"+":(a,b)=>a+b,"*":(a,b)=>a*b,"/":(a,b)=>a/b,"^":(a,b)=>a**b,"<":(a,b)=>+(a<
b),">":(a,b)=>+(a>b),"<=":(a,b)=>+(a<=b),">=":(a,b)=>+(a>=b),neg:a=>-a,ln:Math.log,mod:(a,b)=>a-b*Math.floor(a/b),where:(a,b,c)=>a?
b:c,min:(a,b)=>Math.min(a,b),max:(a,b)=>Math.max(a,b)}));for(let name of"sin cos tan asin acos atan atan2 sinh cosh tanh\
 exp log log2 log10 sqrt abs sign floor ceil hypot".split(" "))OPERATIONS.set(name,Math[name]);function compiled(tree){if(typeof tree==
"number")return()=>tree;if(typeof tree=="string")return values=>values[tree];let[name,...parts]=tree,call=OPERATIONS.get(
String(name));if(!call)throw new Error(`the formula has the operation "${name}", which this client does not support`);let[
first,second,...rest]=parts.map(compiled);return second?rest.length?name==="where"?values=>first(values)?second(values):
rest[0](values):values=>rest.reduce((sum,part)=>call(sum,part(values)),call(first(values),second(values))):values=>call(
first(values),second(values)):values=>call(first(values))}var Grid=class{header;formula;rates;gradients;constructor(header,formula){
[this.header,this.formula]=[header,formula],this.rates=formula.trees.map(compiled),this.gradients=formula.gradient.map(compiled)}at(axis,level,line){
let[low,high]=this.formula.ends[1-axis],cells=(this.header.geometry.shape[axis]-1)*2**this.doublings(level);return line===
cells?high:low+(high-low)*line/cells}get ends(){return this.formula.ends}rate(time,parameters){let values={...parameters,
t:time},[xName,yName]=this.formula.names,at=evaluates=>(x,y)=>(values[xName]=x,values[yName]=y,evaluates.map(evaluate=>evaluate(
values)));return{rate:at(this.rates),gradient:at(this.gradients)}}doublings(level){return(this.header.pyramid?.depth??0)-
level}shape(level){return this.header.geometry.shape.map(n=>(n-1)*2**this.doublings(level)+1)}local(level,row2,column){return this.
localOf([this.at(1,level,column),this.at(0,level,row2)])}localOf([x,y]){let{center,frame}=this.header.geometry;return toFrame(
frame,subtract2([x,y,0],center))}flow({level,from,to},step,parameters){let[rows,columns]=[to[0]-from[0]+1,to[1]-from[1]+
1],{speed:{typical},slices}=this.header,share=2**-this.doublings(level),size=(slices.trace?.unit??1)*share,[dx,dy]=[1,0].
map(axis=>this.at(axis,level,1)-this.at(axis,level,0)),data=new Float32Array(3*rows*columns),speeds=new Float32Array(rows*
columns),values={...parameters,t:slices.times[step]},[xName,yName]=this.formula.names;for(let j=0,n=0;j<rows;j+=1){values[yName]=
this.at(0,level,from[0]+j);for(let i=0;i<columns;i+=1,n+=1){values[xName]=this.at(1,level,from[1]+i);let[u,v2]=this.rates.
map(rate=>rate(values)),speed=Math.hypot(u,v2);speed>0&&speed<MOST_SPEED&&(speeds[n]=speed,data.set([u/dx*size/speed,v2/
dy*size/speed,speed/typical],3*n))}}return{flow:{data,shape:[rows,columns,3]},speeds}}speeds(time,parameters){let{rate}=this.
rate(time,parameters),[rows,columns]=this.header.geometry.shape,root=this.header.pyramid?.depth??0,speeds=[];for(let j=0;j<
rows;j+=1){let y=this.at(0,root,j);for(let i=0;i<columns;i+=1){let speed=Math.hypot(...rate(this.at(1,root,i),y));speed<
MOST_SPEED&&speeds.push(speed)}}return speeds}padded({level,from,to}){let middle=this.local(level,.5*(from[0]+to[0]),.5*
(from[1]+to[1])),[rows,columns]=[to[0]-from[0]+3,to[1]-from[1]+3],data=new Float32Array(3*rows*columns);for(let j=0,n=0;j<
rows;j+=1)for(let i=0;i<columns;i+=1,n+=3)data.set(subtract2(this.local(level,from[0]+j-1,from[1]+i-1),middle),n);return{
middle,part:{data,shape:[rows,columns,3]}}}};function placesOf(header){let{formula,mesh}=header;if(!formula)return null;
let grid=new Grid(header,formula);return(level,row2,column)=>{let shape2=grid.shape(level),corner=far=>grid.local(level,
Math.min((row2+far)*mesh.tileCells,shape2[0]-1),Math.min((column+far)*mesh.tileCells,shape2[1]-1)),[low,high]=[corner(0),
corner(1)],cell=Math.hypot(...subtract2(grid.local(level,0,1),grid.local(level,0,0))),own=low.map((x,k)=>.5*(x+high[k])),
{center,frame}=header.geometry;return[...[0,1,2].map(k=>center[k]+own.reduce((sum,x,m)=>sum+frame[3*m+k]*x,0)),.5*Math.hypot(
...subtract2(high,low))+cell,cell]}}var MEASURED_STEPS=8,FormulaSource=class{hasSteps=!0;hasMarks=!0;atOnce=2;header;grid;rules;parameters={};hasMoved=!1;state="";window=null;constructor(header,formula){
this.header=header,this.grid=new Grid(header,formula),this.rules=formula.range,this.follow(header.settings)}follow(settings){
let own=Object.entries(settings).filter(([name])=>name.startsWith(PARAMETER));this.parameters=Object.fromEntries(own.map(
([name,value])=>[name.slice(PARAMETER.length),Number(value)]));let before=this.state;return this.state=JSON.stringify([this.
header.formula,this.header.geometry,this.parameters]),before!==this.state}fit(){let{table}=this.header,isMoved=table.some(
({name,default:own})=>name.startsWith(PARAMETER)&&this.parameters[name.slice(PARAMETER.length)]!==own);return(isMoved||this.
hasMoved)&&this.measure(),this.hasMoved||=isMoved,this.hasMoved}measure(){let{speed,scalars,slices}=this.header,every=Math.
ceil(slices.times.length/MEASURED_STEPS),values=[...slices.times.keys()].filter(step=>step%every===0).flatMap(step=>this.
grid.speeds(slices.times[step],this.parameters)),moving=values.filter(value=>value>0),sum=moving.reduce((total2,value)=>total2+
value**2,0);!slices.trace?.timed&&moving.length&&(speed.typical=Math.sqrt(sum/moving.length));let range=rangeOf(Float64Array.
from(values),this.rules),choice=scalars.choices[scalars.number];choice&&range&&Object.assign(choice,range)}look(camera,names){
let{ends:ends2}=this.grid,side=Math.max(...ends2.map(([low,high])=>high-low)),size=side/2**Math.floor(Math.log2(side/(2*
WINDOW_VIEWS*camera.height*Math.max(camera.aspect,1)))),step=size/WINDOW_STEPS,window2=ends2.map(([low,high],k)=>{let middle=low+
step*Math.round((camera.state.focal_point[k]-low)/step);return[Math.max(middle-size/2,low),Math.min(middle+size/2,high)]}),
isPart=size<side&&window2.every(([low,high])=>low<high);return String(this.window)===String(isPart?window2:null)?[]:(this.
window=isPart?window2:null,[...names].filter(name=>name.startsWith("nullclines/")).map(name=>this.marks("nullclines",stepOf(
name))))}load=(key,steps,_signal,_has,mark)=>mark?Promise.resolve(steps.map(step=>this.marks(mark,step))):Promise.resolve(
key?this.tile(key,steps):this.whole(steps));marks(kind,step){let{grid,header}=this,{rate,gradient}=grid.rate(header.slices.
times[step],this.parameters),points=kind==="nullclines"?[]:fixedPoints(rate,gradient,grid.ends),kinds=header.structure?.
kinds.map(({name})=>name)??[],row2=(at,number)=>[...grid.localOf(at),number],rows=[];if(kind==="nullclines")nullclines(rate,
grid.ends,this.window).forEach((pieces,component)=>rows.push(...pieces.flat().map(at=>row2(at,component))));else if(kind===
"critical")rows.push(...points.map(point=>row2(point.at,kinds.indexOf(point.kind))));else{closedOrbits(rate,grid.ends,points).
forEach(({path,isStable},n)=>{let number=LINE.orbit+LINE.leaving*Number(isStable)+n%2;rows.push(...path.map(at=>row2(at,
number)))});let saddles=points.filter(({ways})=>ways.length).slice(0,MOST_SADDLES);separatrices(rate,gradient,grid.ends,
points,saddles).forEach(({path,orbit,saddle,leaves},n)=>{let number=LINE.saddle*saddles.indexOf(saddle)+LINE.leaving*Number(
leaves)+n%2;rows.push(...path.map(at=>row2(at,number))),rows.push(...(orbit??[]).map(at=>row2(at,number+LINE.orbit)))})}
let part=this.named(`${kind}/${step}`,{data:Float32Array.from(rows.flat()),shape:[rows.length,4]});return kind==="nullcl\
ines"?{...part,digest:`${part.digest} ${this.window}`}:part}trajectory([x,y]){let{grid,header}=this;if(header.slices.times.
length>1)return null;let{rate,gradient}=grid.rate(header.slices.times[0],this.parameters),inSpace=([u,v2])=>[u,v2,0],velocity=inSpace(
rate(x,y));if(!velocity.every(Number.isFinite))return null;let points=fixedPoints(rate,gradient,grid.ends);return{path:trajectory(
rate,grid.ends,points,[x,y]).map(inSpace),velocity}}whole(steps){let{shape:shape2}=this.header.geometry,level=this.header.
pyramid?.depth??0;return this.parts({level,from:[0,0],to:[shape2[0]-1,shape2[1]-1]},steps,[0,0],shape2)}named(name,part){
return{...part,name,digest:`${this.state} ${name}`}}parts(window2,steps,drawn,shape2,prefix=""){return steps.flatMap(step=>{
let{flow,speeds}=this.grid.flow(window2,step,this.parameters),width=flow.shape[1],data=new Float32Array(shape2[0]*shape2[1]);
for(let j=0;j<shape2[0];j+=1){let start=(j+drawn[0])*width+drawn[1];data.set(speeds.subarray(start,start+shape2[1]),j*shape2[1])}
let values=`scalars/${this.header.scalars.steps>1?step:0}`;return[this.named(`${prefix}flow/${step}`,flow),this.named(`${prefix}${values}`,
{data,shape:[...shape2]})]})}tile(key,steps){let{header,grid}=this,{mesh,pyramid,geometry,slices}=header,{trace}=slices;
if(!pyramid||!trace)throw new Error("the levels of the formula are missing");let[level,...place]=key,cells=pyramid.tileBlocks*
mesh.tileCells,count2=grid.shape(level),first=place.map(at=>at*cells),last=first.map((at,axis)=>Math.min(at+cells,count2[axis]-
1)),from=first.map(at=>Math.max(at-HALO,0)),to=last.map((at,axis)=>Math.min(at+HALO,count2[axis]-1)),nodes=to.map((at,axis)=>at-
from[axis]+1),drawn=first.map((at,axis)=>at-from[axis]),shape2=last.map((at,axis)=>at-first[axis]+1),window2={level,from,
to},{middle,part:padded}=grid.padded(window2),share=2**-grid.doublings(level),lags=[...slices.lags.filter(lag=>lag<pyramid.
pathCells),pyramid.pathCells],texels=n=>({before:BEFORE,size:BEFORE*Math.ceil((n+2*BEFORE)/BEFORE)}),own={geometry:{...geometry,
shape:shape2,rows:texels(shape2[0]),columns:texels(shape2[1]),levels:LEVELS},slices:{...slices,lags,count:slices.count-slices.
sides*(slices.lags.length-lags.length),extra:[],unit:slices.unit*share,lagUnit:slices.lagUnit*share,cell:slices.cell*share,
critical:slices.critical*share,trace:{...trace,nodes,drawn,first:drawn.map(n=>n-BEFORE),middle,unit:trace.unit*share,timed:trace.
timed&&{...trace.timed,unit:trace.timed.unit*share}}}},prefix=`tile/${nameOf(key)}/`,text=new TextEncoder().encode(JSON.
stringify(own)),parts=this.parts(window2,steps,drawn,shape2,prefix);return[this.named(`${prefix}header`,{data:text,shape:[
text.length]}),this.named(`${prefix}padded`,padded),this.named(`${prefix}unit`,{data:new Uint16Array(nodes[0]*nodes[1]).
fill(HALF_ONE),shape:nodes}),this.named(`${prefix}mesh`,this.blocks(key,shape2)),...parts]}blocks(key,shape2){let{mesh,pyramid}=this.
header,[rows,columns]=shape2.map(n=>Math.ceil((n-1)/mesh.tileCells)),data=new Float32Array(rows*columns*PLACE2),place=placesOf(
this.header),tileBlocks=pyramid?.tileBlocks??1;for(let block=0;block<rows*columns;block+=1){let[row2,column]=[Math.floor(
block/columns),block%columns],where=place?.(key[0],key[1]*tileBlocks+row2,key[2]*tileBlocks+column)??[];data.set(where,block*
PLACE2)}return{data,shape:[rows,columns,PLACE2]}}};var FAILED_MS=1e4,SPARE_MS=20,AT_ONCE=4,SPARE_STEPS=4,ALL_COARSE="The surface is shown coarse",COARSE="A part of the sur\
face is shown coarse",ABSENT_STEP="A time step cannot be shown",Failures=class{times=new Map;now;constructor(now=()=>performance.
now()){this.now=now}add(name){this.times.set(name,this.now())}has(name){return this.now()-(this.times.get(name)??-1/0)<FAILED_MS}},
Queue=class{source;taker;running=new Map;jobs=[];failed=new Failures;constructor(source,taker){this.source=source,this.taker=
taker}want(jobs){this.jobs=jobs;let names=new Set(jobs.map(String));for(let[name,controller]of this.running)names.has(name)||
(this.running.delete(name),controller.abort());this.next()}stop(){this.want([]),this.failed=new Failures}next(){for(let job of this.
jobs){if(this.running.size>=(this.source()?.atOnce??AT_ONCE))return;!this.running.has(String(job))&&!this.failed.has(String(
job))&&this.run(job)}}async run(job){let{taker}=this,source=this.source();if(!source)return;let[key,steps,mark]=job,controller=new AbortController,
{signal}=controller,has=part=>key?taker.tiles?.has(nameOf(key),part)??!1:taker.parts.has(part);this.running.set(String(job),
controller);try{let parts=await source.load(key,steps,signal,has,mark);if(!signal.aborted)for(let part of parts)taker.setPart(
part)}catch(error){signal.aborted||this.fail(job,error)}signal.aborted||(this.running.delete(String(job)),this.failed.has(
String(job))||(this.jobs=this.jobs.filter(other=>String(other)!==String(job))),this.next())}fail(job,error){let[key,steps]=job;
this.failed.add(String(job)),setTimeout(()=>this.next(),FAILED_MS+SPARE_MS);let isAway=error.fault==="unreachable",name=key&&
!isAway?nameOf(key):void 0;this.taker.lack(wordsOf(key?COARSE:ABSENT_STEP,error),name,steps)}};function wordsOf(what,error){
let{fault,message=String(error),detail=""}=error;return console.warn(message,detail),fault==="other"?message:`${what}: ${message}`}
var Requests=class{tiles;wholes;marks;given;formula=null;constructor(source,taker){this.given=source,this.tiles=new Queue(
()=>this.source,taker),this.wholes=new Queue(()=>this.source,taker),this.marks=new Queue(()=>this.source,taker)}get source(){
return this.formula??this.given}get hasSteps(){return this.source?.hasSteps??!1}get hasMarks(){return this.source?.hasMarks??
!1}setHeader(header){this.stop(),this.formula=header.formula?new FormulaSource(header,header.formula):null}follow(settings){
return this.formula?.follow(settings)??!1}fit(){return this.formula?.fit()??!1}trajectory(position){return this.formula?.
trajectory(position)??null}open(){let{taker}=this.tiles;this.source?.open?.().catch(error=>taker.lack(wordsOf(ALL_COARSE,
error)))}wantTiles(keys,steps){this.tiles.want(keys.map(key=>[key,steps]))}wantSteps(steps){let before=this.wholes.jobs.
flatMap(([,some])=>some);if(steps.every(step=>before.includes(step)))return;let wanted=[...new Set([...steps,...before])].
slice(0,steps.length+SPARE_STEPS);this.wholes.want(wanted.map(step=>[null,[step]]))}wantMarks(marks){let jobs=marks.map(
([kind,step])=>[null,[step],kind]);String(jobs)!==String(this.marks.jobs)&&this.marks.want(jobs)}stop(){this.tiles.stop(),
this.wholes.stop(),this.marks.stop()}},Messages=class{hasSteps=!0;hasMarks=!0;send;requests=new Map;constructor(send){this.
send=send}load=(key,steps,signal,_has,mark)=>{let request=String(Math.random());return this.send({kind:"load",request,key,
steps,...mark&&{mark}}),signal.addEventListener("abort",()=>{this.requests.delete(request),this.send({kind:"drop",request})}),
new Promise((resolve,reject)=>{this.requests.set(request,error=>error?reject(new Error(error)):resolve([]))})};end({request,
error}){this.requests.get(request)?.(error),this.requests.delete(request)}};function placedCamera({geometry,limits,earth},first,nodes,aspect){let state=firstLook(geometry,limits,first,nodes,aspect);
return new Camera(state,limits,geometry.planar,aspect,earth&&!earth.map?earth.radius:0)}function viewState({header,camera,
anchor,player,rows},shown,density){let{geometry,constants}=header,focus=camera.state.focal_point,local=toFrame(geometry.
frame,subtract2(focus,geometry.center)),range=constants.anchorRange*2*camera.height,isFar=v2=>v2.some(c=>Math.abs(c)>range);
return{focus,anchor:isFar(subtract2(local,anchor))?isFar(local)?local:[0,0,0]:anchor,eye:camera.eye,between:shown[2],time:player.
timeOf(shown),clock:player.clock,still:!player.playing,density,pixel:2*camera.height/Math.max(rows*density,1)}}var NO_VALUE=-1e9,MOST_RANGES=500;function positions(data,anchor){if(data instanceof Float32Array&&!anchor.some(Boolean))
return data;let result2=new Float32Array(data.length);for(let n=0;n<data.length;n+=1)result2[n]=data[n]-anchor[n%3];return result2}
function coordinates({shape:shape2,rows,columns}){return Float32Array.from({length:2*shape2[0]*shape2[1]},(_,n)=>{let[at,
{before,size}]=n%2?[Math.floor((n>>1)/shape2[1]),rows]:[(n>>1)%shape2[1],columns];return(at+before+.5)/size})}function alongAxes(alongI,alongJ){
let count2=Math.max(alongI.length,alongJ.length);return Float32Array.from({length:2*count2},(_,n)=>(n%2?alongJ:alongI)[n>>
1]??0)}function unitNormals(data){let result2=Float32Array.from(data);for(let n=0;n<data.length;n+=3){let size=Math.hypot(
data[n],data[n+1],data[n+2])||1;for(let k=n;k<n+3;k+=1)result2[k]/=size}return result2}function shares(steps,scalars){let nodes=steps[0]?.
length??0,result2=new Float32Array(2*nodes),place=shareOf(scalars);return steps.forEach((values,k)=>{for(let n=0;n<nodes;n+=
1){let share=place(values[n]);result2[2*n+k]=Number.isFinite(share)?clamp(share,-MOST_RANGES,MOST_RANGES):NO_VALUE}}),result2}
function cornersAt([rows,columns],[i,j]){let[left,low]=[Math.min(Math.floor(i),columns-2),Math.min(Math.floor(j),rows-2)],
[a,b]=[i-left,j-low],corner=low*columns+left,[least,most]=[Math.min(a,b),Math.max(a,b)],aside=corner+(a>=b?1:columns);return[
[corner,1-most],[aside,most-least],[corner+columns+1,least]]}function interpolated(corners,value){return corners.reduce(
(sum,[node,share])=>sum+share*value(node),0)}var MOST_SHARE=1-1e-7;function cornersAndBlocks(triangles,blocks){return Uint32Array.
from({length:4*blocks.length},(_,n)=>n%4<3?triangles[3*(n>>2)+n%4]:blocks[n>>2])}function placeIn(triangle,second,third){
return[third,triangle+Math.min(Math.max(second,0),MOST_SHARE)]}function cornersOf(triangles,[i,j]){let number=Math.floor(
j),[second,third]=[j-number,i];return[1-second-third,second,third].map((share,k)=>[triangles[3*number+k],share])}var DEGREES=180/Math.PI,FEWEST_DECIMALS=2,MOST_DECIMALS=4,NEAR=1e-4,DAY_S=86400;function weights(t){let[a,b,c]=[t-1,t-2,
t-3];return[-(a*b*c)/6,t*b*c/2,-(t*a*c)/2,t*a*b/6]}function around(share,count2){let at=share*(count2-1),first=clamp(Math.
floor(at)-1,0,count2-4);return[first,weights(at-first)]}function wayOn([x0,y0,x1,y1],{data,shape:shape2},position){let[rows,
columns]=shape2,[i,across]=around((position[0]-x0)/(x1-x0),columns),[j,upward]=around((position[1]-y0)/(y1-y0),rows),way=[
0,0,0];return upward.forEach((v2,n)=>{across.forEach((u,m)=>{for(let k=0;k<3;k+=1)way[k]+=u*v2*data[3*((j+n)*columns+i+m)+
k]})}),way}function lonLatOf(earth,position,places){if(earth.map&&!places)return null;let[x,y,z]=earth.map&&places?wayOn(
earth.map,places,position):position,lonLat=[Math.atan2(y,x),Math.atan2(z,Math.hypot(x,y))];return lonLat.every(Number.isFinite)?
[lonLat[0]*DEGREES,lonLat[1]*DEGREES]:null}function eastNorth(earth,position,velocity,places){let[from,change]=[position,
velocity];if(earth.map&&places){let{map,radius}=earth,time=NEAR*(map[2]-map[0])/(Math.hypot(...velocity)||1),[before,after]=[
-time,time].map(t=>wayOn(map,places,position.map((p,k)=>p+t*velocity[k])));from=wayOn(map,places,position),change=after.
map((way,k)=>radius*(way-before[k])/(2*time))}let[x,y,z]=from,[across,away]=[Math.hypot(x,y)||1,Math.hypot(x,y,z)||1],east=(x*
change[1]-y*change[0])/across,outward=(x*change[0]+y*change[1])/across;return[east,(across*change[2]-z*outward)/away]}function lonLatText([
lon,lat],apart){let decimals=clamp(Math.ceil(-Math.log10(apart)),FEWEST_DECIMALS,MOST_DECIMALS),told=(degrees,[before,after])=>`${Math.
abs(degrees).toFixed(decimals)}° ${degrees<0?before:after}`;return`${told(lon,"WE")}, ${told(lat,"SN")}`}function dateText({
start,dates,step},times2,time){if(start===null){if(!dates.length)return null;let apart=times2.map(each=>Math.abs(each-time));
return dates[apart.indexOf(Math.min(...apart))]}let first=Date.parse(`${start}Z`),isMidnight=first%(1e3*DAY_S)===0,text=new Date(
first+1e3*time).toISOString();return isMidnight&&step%DAY_S===0&&time%DAY_S===0?text.slice(0,10):text.slice(0,step>=60?16:
19).replace("T"," ")}var SPEED_LAYER=2,POINTS_BETWEEN_SLICES=8,PATH_LENGTH=4,FEWEST_SAMPLES=10,LEAST_FACING=.05,LEAST_ROUND=.25,LEAST_ACROSS=.75,
MOST_STRETCH=4,LEAST_STRETCH=.01,LEAST_SLOPE=1e-6,SMALL=.001;function texelsAt({scene,place},[di,dj]){let{rows,columns,triangles}=scene.
header.geometry;if(triangles){let more=[-di-dj,di,dj];return scene.cornersAt(place).map(([node,share],n)=>[node,share+more[n]])}
let[x,y]=[place[0]+di+columns.before,place[1]+dj+rows.before],[left,low]=[Math.floor(x),Math.floor(y)],[s,t]=[x-left,y-low];
return[(1-s)*(1-t),s*(1-t),(1-s)*t,s*t].map((share,n)=>{let column=clamp(left+(n&1),0,columns.size-1);return[clamp(low+(n>>
1),0,rows.size-1)*columns.size+column,share]})}function layersAt(at,beside=[0,0]){let{scene,moment}=at,{slices}=scene.header,
texels=texelsAt(at,beside),[before,after,late]=moment,numbers=texels.map(([texel])=>texel),steps=(before===after?[before]:
[before,after]).map(step=>scene.texels(step,numbers)),shares2=before===after?[1]:[1-late,late],signs=isSignFree(scene.header)?
signsOf(texels.map((_,n)=>steps[0](0,n))):texels.map(()=>1);return layer=>{let sum=[0,0,0,0];return texels.forEach(([,weight],n)=>{
let other=layer+(layer>slices.lags.length?-1:1)*slices.lags.length,from=signs[n]<0&&layer>0?other:layer;steps.forEach((step,k)=>{
shares2[k]&&step(from,n).forEach((channel,c)=>{let value=layer===SPEED_LAYER&&c===3?Math.max(channel,0):channel;sum[c]+=
weight*shares2[k]*value*(c<3?signs[n]:1)})})}),sum}}function signsOf(tangents){let together=[0,0,0];return tangents.map(
([x,y,z])=>{let sign=dot2(together,[x,y,z])<0?-1:1;return together=add(together,[x,y,z],sign),sign})}function sideOf(layers,lags,first,sign,by){
let[before,from]=[layers(0).slice(0,3),0],reach=layers(first+1)[3],end=Math.min(reach,lags[lags.length-1]),result2=[];for(let m=0;m<
lags.length&&from<end;m+=1){let after=layers(first+m+1).slice(0,3);for(let n=1;n<=POINTS_BETWEEN_SLICES;n+=1){let share=n/
POINTS_BETWEEN_SLICES,lag=Math.min(from+share*(lags[m]-from),end),late=(lag-from)/(lags[m]-from),slope=before.map((x,c)=>x+
late*(after[c]-x));if(result2.push(scale2(slope,sign*lag*by)),lag===end)break}[before,from]=[after,lags[m]]}return result2}
function mover({scene,place,position}){let{image,geometry}=scene.header;if(!image)return moved=>add(position,fromFrame(geometry.
frame,moved));let{alongI,alongJ}=image,here=[between(alongI,place[0]),between(alongJ,place[1])],start=pointAt(scene,place);
return([u,v2])=>{let at=[indexOf(alongI,here[0]+u),indexOf(alongJ,here[1]+v2)];return at.some(Number.isNaN)?null:add(position,
subtract2(pointAt(scene,at),start))}}function nodeAt(scene,place){return add(pointAt(scene,place),scene.header.geometry.
center)}function pointAt(scene,place){let{data}=scene.part("position"),corners=scene.cornersAt(place),local=[0,1,2].map(
c=>interpolated(corners,n=>data[3*n+c]));return fromFrame(scene.header.geometry.frame,local)}function sidesAt(scene,place){
let{shape:shape2,triangles}=scene.header.geometry;if(triangles){let corner=(second,third)=>pointAt(scene,placeIn(Math.floor(
place[1]),second,third));return[subtract2(corner(1,0),corner(0,0)),subtract2(corner(0,1),corner(0,0))]}let[i,j]=place.map(
(n,axis)=>clamp(n,.5,shape2[1-axis]-1.5)),at=(di,dj)=>pointAt(scene,[i+di,j+dj]);return[subtract2(at(.5,0),at(-.5,0)),subtract2(
at(0,.5),at(0,-.5))]}function partingAt(at,half){let{scene,place}=at,[first,second]=sidesAt(scene,place),normal=cross2(first,
second),wayAt=beside=>unit(fromFrame(scene.header.geometry.frame,layersAt(at,beside)(0).slice(0,3))),across=unit(cross2(
normal,wayAt([0,0]))),by=half/dot2(normal,normal),[di,dj]=[cross2(second,normal),cross2(normal,first)].map(side=>by*dot2(
across,side));return .5*dot2(across,subtract2(wayAt([di,dj]),wayAt([-di,-dj])))}function between(values,at){let n=Math.min(
Math.floor(at),values.length-2);return values[n]+(at-n)*(values[n+1]-values[n])}function indexOf(values,value){let n=values.
findIndex(other=>other>=value);return n<0||value<values[0]?NaN:n===0?0:n-1+(value-values[n-1])/(values[n]-values[n-1])}function grainAt(at,settings,camera,rows){
let{scene,place,position}=at,{geometry,image}=scene.header,{height,ray}=camera.at(position),pixel=2*height/rows;if(image){
let normal=cross2(...sidesAt(scene,place)),facing=Math.max(Math.abs(dot2(unit(normal),ray)),LEAST_FACING),[across,up]=[image.
alongI,image.alongJ].map((along2,axis)=>{let n=Math.min(Math.floor(place[axis]),along2.length-2);return(along2[n+1]-along2[n])*
image.stepSize[axis]}),texel2=Math.sqrt(length2(normal)/(across*up)),grain2=image.deviations?pixel*Number(settings.grain):
pixel;return settings.lod?Math.max(grain2/Math.sqrt(facing),texel2):texel2}let texel=geometry.extent/Number(settings.resolution);
if(!settings.lod)return texel;let grain=pixel*footprintAt(at,camera).side*Number(settings.grain);return settings.fixed_grain?
Math.max(grain,texel):grain}function stretchAt(at,settings,camera){if(at.scene.header.image||!settings.lod||settings.fixed_grain)
return 1;let{side,across,area}=footprintAt(at,camera);if(!across)return 1;let stretch=clamp(area/(across*side),1/MOST_STRETCH,
MOST_STRETCH);return Math.abs(stretch-1)<LEAST_STRETCH?1:stretch}function footprintAt(at,camera){let{geometry}=at.scene.
header,normal=unit(cross2(...sidesAt(at.scene,at.place))),across=unit(cross2(normal,fromFrame(geometry.frame,layersAt(at)(
0).slice(0,3)))),{ray}=camera.at(at.position),slant=dot2(normal,ray),facing=(slant<0?-1:1)*Math.max(Math.abs(slant),LEAST_FACING),
[dx,dy]=camera.axes.slice(0,2).map(axis=>add(axis,ray,-dot2(normal,axis)/facing)),area=length2(cross2(dx,dy)),half=.5*(dot2(
dx,dx)+dot2(dy,dy)),longer=Math.sqrt(half+Math.sqrt(Math.max(half**2-area**2,0))),mean=Math.sqrt(longer*Math.max(area/longer,
LEAST_ROUND*longer)),aside=Math.hypot(dot2(dx,across),dot2(dy,across));return{side:Math.max(mean,LEAST_ACROSS*aside),across:aside,
area}}function upTo(start,side,most){let result2=[],[from,left]=[start,most];for(let point of side){let step=length2(subtract2(
point,from));if(step>=left){left>0&&result2.push(add(from,subtract2(point,from),left/(step||1)));break}result2.push(point),
left-=step,from=point}return result2}function stepsAround([before,after,late]){return before===after?[[[before,before,0],
1]]:[[[before,before,0],1-late],[[after,after,0],late]]}function velocityAt(at){let velocity=[0,0,0];for(let[moment,share]of stepsAround(
at.moment))share&&(velocity=add(velocity,velocityAtStep({...at,moment}),share));return velocity}function velocityAtStep(at){
let{scene,position}=at,{slices,image,speed}=scene.header,layers=layersAt(at),[x,y,z]=layers(0),slope=[x,y,z],small=scale2(
slope,SMALL*(image?1/image.stepSize[0]:slices.cell)/(length2(slope)||1)),along2=length2(slope)>LEAST_SLOPE?subtract2(mover(
at)(small)??position,position):slope;return scale2(unit(along2),layers(SPEED_LAYER)[3]*speed.typical)}function pathThrough(at,settings,camera,rows){
let{scene,position}=at,{slices,image}=scene.header,layers=layersAt(at),directed=!isSignFree(scene.header),base=layers(0),
slope=[base[0],base[1],base[2]],moved=mover(at),whole=[],sides=settings.two_sided||!directed?slices.sides:1;for(let side=0;side<
sides&&length2(slope)>LEAST_SLOPE;side+=1){let by=image?1:base[3]*slices.unit,points=sideOf(layers,slices.lags,side*slices.
lags.length,side?1:-1,by).map(moved),end=points.findIndex(point=>point===null);whole.push(points.slice(0,end<0?void 0:end))}
let set=Number(settings.samples),samples=isMoving(scene.header,settings,!0)?2*set-1:set,count2=(sides===2?Math.floor(samples/
2):samples-1)*stretchAt(at,settings,camera),step=Number(settings.spacing)*grainAt(at,settings,camera,rows),joined=reach=>{
let[back=[],ahead=[]]=whole.map(side=>upTo(position,side,reach));return[...back.reverse(),position,...ahead]};return{path:joined(
PATH_LENGTH*Math.max(count2,FEWEST_SAMPLES)*step),sampled:joined(count2*step),directed,velocity:velocityAt(at)}}var MOST_CELLS=8,ROUNDING2=1e-6,SKEW=.001,POLE_LATITUDE=89.99,turned=lon=>lon-360*Math.round(lon/360);function cornersOf2([
i,j]){return[[i,j],[i+1,j],[i,j+1],[i+1,j+1]]}function cellOf({header},place){return place.map((at,axis)=>clamp(Math.floor(
at),0,header.geometry.shape[1-axis]-2))}var sharesOf=([s,t])=>[(1-s)*(1-t),s*(1-t),(1-s)*t,s*t];function sharesIn(scene,cell,[
lon,lat],places){let{earth}=scene.header,known=cornersOf2(cell).map(node=>earth&&lonLatOf(earth,nodeAt(scene,node),places));
if(known.some(each=>!each||Math.abs(each[1])>POLE_LATITUDE))return null;let[a,b,c,d]=known.map(each=>[turned(each[0]-lon),
each[1]-lat]),[first,second]=[b,c].map(each=>[each[0]-a[0],each[1]-a[1]]),size=Math.max(...[...first,...second].map(Math.
abs)),area=first[0]*second[1]-first[1]*second[0];return!area||[0,1].some(k=>Math.abs(a[k]-b[k]-c[k]+d[k])>SKEW*size)?null:
[(a[1]*second[0]-a[0]*second[1])/area,(a[0]*first[1]-a[1]*first[0])/area]}function placeOnEarth(scene,near,position,places){
let{earth,geometry}=scene.header,lonLat=earth&&!geometry.triangles&&lonLatOf(earth,position,places);if(!lonLat)return near;
let cell=cellOf(scene,near);for(let n=0;n<MOST_CELLS;n+=1){let shares2=sharesIn(scene,cell,lonLat,places);if(!shares2)return near;
let beyond=shares2.map(share=>Math.abs(share-.5)>.5+ROUNDING2?share:0),beside=cellOf(scene,cell.map((first,k)=>first+beyond[k]));
if(String(beside)===String(cell))return cell.map((at,k)=>at+clamp(shares2[k],0,1));cell=beside}return near}function cornersOn(scene,place){
let{earth,geometry}=scene.header;if(!earth||geometry.triangles)return scene.cornersAt(place);let cell=cellOf(scene,place),
shares2=sharesOf(place.map((at,k)=>at-cell[k]));return cornersOf2(cell).map(([i,j],n)=>[j*geometry.shape[1]+i,shares2[n]])}
function velocityOnEarth(at,places){let{scene,place,position}=at,{earth,geometry}=scene.header,lonLat=earth&&lonLatOf(earth,
position,places);if(!lonLat)return null;let componentsAt=each=>eastNorth(earth,each.position,velocityAt(each),places),cell=cellOf(
scene,place);if(geometry.triangles||!sharesIn(scene,cell,lonLat,places))return componentsAt(at);let shares2=sharesOf(place.
map((each,k)=>each-cell[k])),corners=cornersOf2(cell).map(node=>componentsAt({...at,place:node,position:nodeAt(scene,node)}));
return[0,1].map(k=>corners.reduce((sum,each,n)=>sum+shares2[n]*each[k],0))}function speedAt(at,places){let speed=0;for(let[
moment,share]of stepsAround(at.moment)){let then={...at,moment};share&&(speed+=share*Math.hypot(...velocityOnEarth(then,
places)??velocityAt(then)))}return speed}var FARTHEST=16;function pickedPoint(at,root,camera,moment,[x,y]){let{layer,coordinate,triangle}=at,{geometry}=layer.scene.
header,near=geometry.triangles?placeIn(triangle,...coordinate):placeAmong(geometry,...coordinate),ray=camera.ray(x,y),beside=onRay(
layer.scene,near,ray)[1],[position,there]=onRay(layer.scene,beside,ray),place=placeOnEarth(layer.scene,there,position,root.
parts.get("lonlat")),index=geometry.triangles?place:wholeIndex(root.header,layer,place);return{point:{position,index,values:valuesAt(
layer.scene,moment,place)},layer,place}}function placeAmong({rows,columns,shape:shape2},u,v2){let at=(share,{size,before},nodes)=>clamp(
share*size-.5-before,0,nodes-1);return[at(u,columns,shape2[1]),at(v2,rows,shape2[0])]}function wholeIndex(header,{key},[
i,j]){let{pyramid,geometry,mesh,formula}=header,[level,row2,column]=key,[rows,columns]=pyramid?.shapes[0]??geometry.shape,
side=mesh.tileCells*(pyramid?.tileBlocks??0),finer=formula?2**(pyramid?.depth??0):1,at=(n,tile,nodes)=>fullIndex(n+tile*
side,level,nodes)/finer;return[at(i,column,columns),at(j,row2,rows)]}function onRay(scene,near,[start,along2]){let{geometry}=scene.
header,{data}=scene.part("position"),nodes=scene.cornersAt(near).map(([node])=>node),[a,b,c]=nodes.map(n=>add(fromFrame(
geometry.frame,[...data.subarray(3*n,3*n+3)]),geometry.center)),[first,second]=[subtract2(b,a),subtract2(c,a)],normal=cross2(
first,second),position=add(start,along2,dot2(normal,subtract2(a,start))/dot2(normal,along2)),way=subtract2(position,a),[
s,t]=[cross2(way,second),cross2(first,way)].map(each=>dot2(each,normal)/dot2(normal,normal));if(!(Math.max(Math.abs(s),Math.
abs(t))<FARTHEST)){let about=nodeAt(scene,near);return[add(start,along2,dot2(subtract2(about,start),along2)/dot2(along2,
along2)),near]}if(geometry.triangles)return[position,placeIn(Math.floor(near[1]),s,Math.max(t,0))];let[rows,columns]=geometry.
shape,at=(of,count2)=>{let[own,one,two]=nodes.map(of);return clamp(own+s*(one-own)+t*(two-own),0,count2-1)};return[position,
[at(n=>n%columns,columns),at(n=>Math.floor(n/columns),rows)]]}function valuesAt(scene,moment,place){let{header,parts}=scene,
{scalars,geometry}=header,corners=cornersOn(scene,place),cell=geometry.triangles?Math.floor(place[1]):corners[0][0],[from,
to,between3]=moment,values={},others=scalars.choices.map((choice,number)=>({...choice,number}));for(let each of[scalars,
...others]){let names=scene.scalarParts(from,to,each),[before,after]=names.map(part=>parts.get(part)?.data);if(each.name===
null||each.name in values||!before||!after)continue;let value=n=>before[n]+between3*(after[n]-before[n]);values[each.name]=
each.flat?value(cell):interpolated(corners,value)}return values}function evenBlocks({sigma,radii},grain,[left,low,right,high]){let deviation=sigma*grain,side=2**Math.max(Math.floor(Math.
log2(Math.SQRT2*deviation)),0),own=side>1?side**2/6+1/12:0,variance=deviation**2-own,[x,y]=[left,low].map(at=>Math.floor(
at/side)*side),[columns,rows]=[right-x,high-y].map(pixels=>Math.ceil(pixels/side)+2),reach=radii*Math.sqrt(variance);return{
side,first:[x,y],end:[right,high],columns,rows,variance,reach}}var LocalMeans=class{graphics;targets=[];columns=0;rows=0;constructor(graphics){
this.graphics=graphics}draw(blur,blocks,texture){let{graphics}=this,gl=graphics.context,{side,first,end,columns,rows,variance,
reach}=blocks,[across,upward]=[end[0]-first[0],end[1]-first[1]];this.fit(columns,Math.max(upward,rows)),gl.bindVertexArray(
null);for(let test of[gl.SCISSOR_TEST,gl.DEPTH_TEST,gl.BLEND])gl.disable(test);let[byRow,means]=this.targets,values={u_side:side,
u_variance:variance,u_reach:reach};graphics.programs.use(blur,{...values,u_from:first,u_along:[1,0],u_count:across}),this.
pass(byRow,columns,upward,texture),graphics.programs.use(blur,{u_from:[0,0],u_along:[0,1],u_count:upward}),this.pass(means,
columns,rows,byRow.texture),this.bind("u_means",means.texture)}dispose(){for(let{frame,texture}of this.targets)this.graphics.
free("Framebuffer",frame),this.graphics.free("Texture",texture);this.targets=[],this.columns=this.rows=0}pass({frame},width,height,source){
let gl=this.graphics.context;this.bind("u_source",source),gl.bindFramebuffer(gl.FRAMEBUFFER,frame),gl.viewport(0,0,width,
height),gl.drawArrays(gl.TRIANGLES,0,3)}bind(name,texture){let gl=this.graphics.context;gl.activeTexture(gl.TEXTURE0+SAMPLERS.
indexOf(name)),gl.bindTexture(gl.TEXTURE_2D,texture),gl.activeTexture(gl.TEXTURE0+SAMPLERS.length)}fit(columns,rows){if(this.
columns>=columns&&this.rows>=rows)return;let[wide,high]=[Math.max(columns,this.columns),Math.max(rows,this.rows)];this.dispose();
let{graphics}=this,gl=graphics.context;this.targets=[0,1].map(()=>{let texture=graphics.counted(gl.createTexture());gl.bindTexture(
gl.TEXTURE_2D,texture),gl.texStorage2D(gl.TEXTURE_2D,1,gl.R16F,wide,high),gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_MIN_FILTER,
gl.NEAREST),gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_MAG_FILTER,gl.NEAREST);let frame=graphics.counted(gl.createFramebuffer());
return gl.bindFramebuffer(gl.FRAMEBUFFER,frame),gl.framebufferTexture2D(gl.FRAMEBUFFER,gl.COLOR_ATTACHMENT0,gl.TEXTURE_2D,
texture,0),{frame,texture}}),[this.columns,this.rows]=[wide,high]}};var MOST_SIDE_PX=3,PLACE3=5;function mostDoublings({shape:shape2,triangles},blocks,positions2,cells){let[rows,columns]=blocks.
shape,most=new Int8Array(rows*columns).fill(triangles?0:Math.log2(cells));for(let n=0;n<positions2.length;n+=3){if(Number.
isFinite(positions2[n]))continue;let[j,i]=[Math.floor(n/3/shape2[1]),n/3%shape2[1]];for(let row2 of[Math.floor((j-1)/cells),
Math.floor(j/cells)])for(let column of[Math.floor((i-1)/cells),Math.floor(i/cells)])row2>=0&&row2<rows&&column>=0&&column<
columns&&(most[row2*columns+column]=0)}return most}function seenBlocks({shape:shape2,data},camera,pixels,covered,most){let[
rows,columns]=shape2,sight={...camera.sight(pixels),planes:camera.planes},levels=new Int8Array(rows*columns).fill(-1),box=[
1,1,-1,-1];for(let block=0;block<levels.length;block+=1){let[row2,column]=[Math.floor(block/columns),block%columns],place=data.
subarray(PLACE3*block,PLACE3*(block+1));if(covered.some(([j,i,n])=>row2>=j&&row2<j+n&&column>=i&&column<i+n)||!isSeen(sight,
place))continue;let level=Math.floor(Math.log2(MOST_SIDE_PX/cellSize(sight,place)));levels[block]=Math.min(Math.max(level,
0),most[block]),boundsOf(camera,place).forEach((side,n)=>box[n]=n<2?Math.min(box[n],side):Math.max(box[n],side))}return{
levels,box}}function boundsOf(camera,[x,y,z,radius]){let[right,up,ahead]=camera.axes,{parallel,position,focal_point:focus}=camera.
state,way=subtract2([x,y,z],parallel?focus:position),ends2=[-radius,radius].map(by=>camera.at(add([x,y,z],ahead,by)).height);
if(!(ends2[0]>0))return[-1,-1,1,1];let[low,high]=[-radius,radius].map(by=>[dot2(way,right)/camera.aspect,dot2(way,up)].map(
(at,axis)=>ends2.map(height=>(at+by/(axis?1:camera.aspect))/height)));return[...low.map(each=>Math.min(...each)),...high.
map(each=>Math.max(...each))]}var MOST_SQUARES=1024,UNITS2=["u_places","u_depths","u_colours","u_strides","u_below","u_texture"].map(name=>SAMPLERS.indexOf(
name)),Places=class{width=0;height=0;graphics;means;target=null;key="";layers=[];seen=[];squares=0;constructor(graphics){
this.graphics=graphics,this.means=new LocalMeans(graphics)}draw({layers,camera,anchor,width,height}){let drawn=layers.map(
({scene,covered})=>[scene.number,scene.version,covered]),key=JSON.stringify([drawn,camera.state,camera.aspect,anchor,width,
height]);if(key===this.key)return;Object.assign(this,{key,layers,width,height});let gl=this.graphics.context,{frames}=this.
make(width,height),[{scene:root}]=layers,most=Math.min(...layers.map(({key:[step]})=>step))+Math.log2(root.header.mesh.tileCells);
this.seen=layers.map(({scene,covered,key:[step]})=>{let doublings=scene.doublings.map(own=>Math.max(Math.min(own,most-step),
0));return seenBlocks(scene.blocks,camera,height,covered,doublings)}),this.sendStrides(),gl.bindFramebuffer(gl.FRAMEBUFFER,
frames[0]),gl.viewport(0,0,width,height),gl.disable(gl.SCISSOR_TEST),gl.enable(gl.DEPTH_TEST),gl.depthFunc(gl.LESS),gl.disable(
gl.BLEND),gl.clearBufferuiv(gl.COLOR,0,[0,0,0,0]),gl.clear(gl.DEPTH_BUFFER_BIT);let matrix=projection(root.header.geometry,
camera,anchor);root.bodies.hide(matrix,anchor),root.bodies.seeThrough(()=>this.triangles(root.programs("place"),matrix,anchor),
!1)}triangles(program,matrix,anchor,values={}){let{graphics,layers,seen}=this,gl=graphics.context,{mesh,pyramid,geometry}=layers[0].
scene.header,[rows,columns]=pyramid?.shapes[0]??geometry.shape;this.bind(),gl.bindVertexArray(null),layers.forEach(({scene,
key:[step,...tile]},n)=>{let{levels}=seen[n],{columns:u,rows:v2,shape:shape2,triangles}=scene.header.geometry,[top,left]=tile.
map(at=>at*mesh.tileCells*(pyramid?.tileBlocks??0)*2**step);scene.bindNodes(anchor),graphics.programs.use(program,{...values,
u_matrix:matrix,u_layer:n+1,u_blocks:levels.reduce((bits,level,block)=>bits|(level<0?0:1<<block),0),u_part:[left,top,step],
u_lastNode:[columns-1,rows-1,this.squares],u_closed:[Number(geometry.periodic[1]),Number(geometry.periodic[0])],u_blockCells:mesh.
tileCells,u_slicesSize:[u.size,v2.size],u_padding:[u.before,v2.before]}),triangles&&gl.drawArrays(gl.TRIANGLES,0,scene.part(
"triangles").data.length);let across=scene.blocks.shape[1];levels.forEach((level,block)=>{if(level<0||triangles)return;let first=[
block%across,Math.floor(block/across)].map(at=>at*mesh.tileCells),[x,y]=first.map((at,k)=>Math.ceil(Math.min(mesh.tileCells,
shape2[1-k]-1-at)/2**level));graphics.programs.use(program,{u_block:[...first,level,x]}),gl.drawArrays(gl.TRIANGLES,0,6*
x*y)})})}sum(program,top,rows,valuesOf){let{graphics,width,height,target}=this,gl=graphics.context,bottom=height-top-rows;
gl.bindFramebuffer(gl.FRAMEBUFFER,target?.frames[1]??null),gl.enable(gl.SCISSOR_TEST),gl.scissor(0,bottom,width,rows),gl.
clearBufferfv(gl.COLOR,1,[0,0,0,0]),this.pixels(program,bottom,rows,valuesOf),gl.readPixels(0,0,1,1,gl.RGBA,gl.UNSIGNED_BYTE,
new Uint8Array(4)),gl.bindFramebuffer(gl.FRAMEBUFFER,null)}colour(grain,valuesOf){let{graphics,layers,means,height,target}=this,
gl=graphics.context,[{scene:root}]=layers;this.bind();let blocks=grain===null?null:evenBlocks(root.header.constants.even,
grain,this.box);blocks&&means.draw(root.programs("blur"),blocks,target?.textures[5]??null),gl.bindFramebuffer(gl.FRAMEBUFFER,
target?.frames[2]??null);let own={u_first:blocks?.first??[0,0],u_side:blocks?.side??1};this.pixels(root.programs("colour"),
0,height,scene=>({...valuesOf(scene),...own})),gl.bindFramebuffer(gl.FRAMEBUFFER,null)}boxOf({box}){let{width,height}=this,
[left,low,right,high]=box.map((at,side)=>(.5+.5*at)*(side%2?height:width));return[...[left,low].map(at=>Math.max(Math.floor(
at),0)),Math.min(Math.ceil(right),width),Math.min(Math.ceil(high),height)]}get box(){let boxes=this.seen.map(seen=>this.
boxOf(seen)).filter(([x,y,right,high])=>x<right&&y<high);return boxes.length?[0,1,2,3].map(side=>{let ends2=boxes.map(box=>box[side]);
return side<2?Math.min(...ends2):Math.max(...ends2)}):[0,0,1,1]}pixels(program,bottom,rows,valuesOf){let{graphics,width,
height}=this,gl=graphics.context;gl.viewport(0,0,width,height),gl.enable(gl.SCISSOR_TEST),gl.disable(gl.DEPTH_TEST),gl.disable(
gl.BLEND),gl.bindVertexArray(null),this.layers.forEach(({scene},n)=>{let[left,low,right,high]=this.boxOf(this.seen[n]),[
x,y]=[left,Math.max(low,bottom)],[w,h]=[right-x,Math.min(high,bottom+rows)-y];if(w<=0||h<=0)return;gl.scissor(x,y,w,h);let values=valuesOf(
scene);this.bind(),graphics.programs.use(program,{...values,u_layer:n+1}),gl.drawArrays(gl.TRIANGLES,0,3)})}show(program){
let gl=this.graphics.context;this.bind(),gl.bindVertexArray(null),this.graphics.programs.use(program,{u_bottom:0}),gl.drawArrays(
gl.TRIANGLES,0,3)}at(x,y){let{graphics,target,layers}=this,gl=graphics.context,[column,row2]=[(.5+.5*x)*this.width,(.5+.5*
y)*this.height],left=clamp(Math.floor(column-.5),0,this.width-2),low=clamp(Math.floor(row2-.5),0,this.height-2),bits=new Uint32Array(
16);gl.bindFramebuffer(gl.FRAMEBUFFER,target?.frames[0]??null),gl.readPixels(left,low,2,2,gl.RGBA_INTEGER,gl.UNSIGNED_INT,
bits),gl.bindFramebuffer(gl.FRAMEBUFFER,null);let own=+(column>=left+1)+2*+(row2>=low+1),at=4*([own,own^1,own^2,own^3].find(
n=>bits[4*n+3])??own),[u,v2]=new Float32Array(bits.buffer,4*at,2);return bits[at+3]?{layer:layers[bits[at+3]-1],coordinate:[
u,v2],triangle:bits[at+2]}:null}dispose(){let{graphics,target}=this;for(let texture of target?.textures??[])graphics.free(
"Texture",texture);for(let frame of target?.frames??[])graphics.free("Framebuffer",frame);this.means.dispose(),this.target=
null,this.key=""}sendStrides(){let{layers,seen,target}=this,gl=this.graphics.context,[{scene:root}]=layers,{pyramid,geometry}=root.
header,finest=geometry.triangles?[1,1]:pyramid?.blocks[0]??root.blocks.shape;this.squares=Math.max(Math.ceil(Math.log2(Math.
max(...finest)/MOST_SQUARES)),0);let scale3=2**-this.squares,[rows,columns]=finest.map(n=>Math.ceil(n*scale3)),strides=new Uint8Array(
rows*columns);layers.forEach(({scene,key:[step,...tile]},n)=>{let across=scene.blocks.shape[1],size=2**step*scale3;seen[n].
levels.forEach((level,block)=>{if(level<0||geometry.triangles)return;let[[top,bottom],[left,right]]=[Math.floor(block/across),
block%across].map((at,k)=>{let first=(at+tile[k]*(pyramid?.tileBlocks??0))*size;return[Math.floor(first),Math.min(Math.ceil(
first+size),[rows,columns][k])]});for(let j=top;j<bottom;j+=1)for(let i=left+j*columns;i<right+j*columns;i+=1)strides[i]=
Math.max(strides[i],step+level)})}),gl.activeTexture(gl.TEXTURE0+UNITS2[3]),gl.bindTexture(gl.TEXTURE_2D,target?.textures[3]??
null),gl.pixelStorei(gl.UNPACK_ALIGNMENT,1),gl.texImage2D(gl.TEXTURE_2D,0,gl.R8UI,columns,rows,0,gl.RED_INTEGER,gl.UNSIGNED_BYTE,
strides)}make(width,height){let{target,graphics}=this;if(target&&target.width>=width&&target.height>=height)return target;
let gl=graphics.context,{key}=this,size={width:Math.max(width,target?.width??0),height:Math.max(height,target?.height??0)};
this.dispose();let textures=[gl.RGBA32UI,gl.DEPTH_COMPONENT24,gl.RGBA8,0,gl.RGBA8,gl.RGBA16F].map(format=>{let texture=graphics.
counted(gl.createTexture());return gl.bindTexture(gl.TEXTURE_2D,texture),format&&gl.texStorage2D(gl.TEXTURE_2D,1,format,
size.width,size.height),gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_MIN_FILTER,gl.NEAREST),gl.texParameteri(gl.TEXTURE_2D,
gl.TEXTURE_MAG_FILTER,gl.NEAREST),texture}),[first,second]=[gl.COLOR_ATTACHMENT0,gl.COLOR_ATTACHMENT1],[places,depths,colours,
,below,sums]=textures,frames=[[[first,places],[gl.DEPTH_ATTACHMENT,depths]],[[first,below],[second,sums]],[[first,colours]]].
map(attached=>{let frame=graphics.counted(gl.createFramebuffer());gl.bindFramebuffer(gl.FRAMEBUFFER,frame);for(let[point,
texture]of attached)gl.framebufferTexture2D(gl.FRAMEBUFFER,point,gl.TEXTURE_2D,texture,0);return gl.drawBuffers(attached.
map(([point])=>point).filter(point=>point!==gl.DEPTH_ATTACHMENT)),frame});return this.key=key,this.target={frames,textures,
...size}}bind(){let gl=this.graphics.context;UNITS2.forEach((unit3,n)=>{gl.activeTexture(gl.TEXTURE0+unit3),gl.bindTexture(
gl.TEXTURE_2D,this.target?.textures[n]??null)}),gl.activeTexture(gl.TEXTURE0+SAMPLERS.length)}};function invert(out,a){var aa=a[0],ab=a[1],ac=a[2],ad=a[3],atx=a[4],aty=a[5],det=aa*ad-ab*ac;return det?(det=1/det,out[0]=
ad*det,out[1]=-ab*det,out[2]=-ac*det,out[3]=aa*det,out[4]=(ac*aty-ad*atx)*det,out[5]=(ab*atx-aa*aty)*det,out):null}function determinant(a){
return a[0]*a[3]-a[1]*a[2]}function multiply(out,a,b){var a0=a[0],a1=a[1],a2=a[2],a3=a[3],a4=a[4],a5=a[5],b0=b[0],b1=b[1],
b2=b[2],b3=b[3],b4=b[4],b5=b[5];return out[0]=a0*b0+a2*b1,out[1]=a1*b0+a3*b1,out[2]=a0*b2+a2*b3,out[3]=a1*b2+a3*b3,out[4]=
a0*b4+a2*b5+a4,out[5]=a1*b4+a3*b5+a5,out}var MOVING_LEAST_MS=14,STRIP_MS=40,SMOOTH_ROWS=256;function replace(pen,picture){pen?.clearRect(0,0,picture.width,picture.
height),pen?.drawImage(picture,0,0)}var penOf=(canvas,alpha)=>canvas.getContext("2d",{alpha}),ProgressiveRenderer=class{viewer;content;graphics;canvas;pen;last=document.
createElement("canvas");lastPen;lastCamera=null;coarse=document.createElement("canvas");coarsePen;front=document.createElement(
"canvas");frontPen=this.front.getContext("2d");frontLook="";version=1;draftVersion=0;rowsDone=0;layers=[];isRefined=!1;fixed=4;isCoarse=!1;constructor(viewer,content){
this.viewer=viewer,this.content=content,this.graphics=viewer.graphics,this.canvas=viewer.canvas;let{canvas,last,coarse}=this,
pens=[canvas,last,coarse].map(each=>penOf(each,viewer.isClear??!1));[this.pen,this.lastPen,this.coarsePen]=pens}restart(cameraOnly=!1){
cameraOnly||(this.lastCamera=null),this.version+=1,this.rowsDone=0}refine(){(this.rowsDone>=this.canvas.height||!this.content.
isComing)&&(this.rowsDone=0),this.isRefined=!0}resize(width,height){let{canvas,coarse,last}=this;coarse.width=canvas.width,
coarse.height=canvas.height,this.coarsePen?.drawImage(canvas,0,0),canvas.width=last.width=width,canvas.height=last.height=
height,coarse.width>1&&this.pen?.drawImage(coarse,0,0,width,height)}dispose(){for(let canvas of[this.last,this.coarse,this.
front])canvas.width=canvas.height=0}draw(program,shown,until){let moving=this.isMoving;if(this.draftVersion!==this.version)
return this.draft(program,shown,moving);if(moving)return!1;let complete=!1;do complete=this.strip(program,shown)&&!this.
isRefined;while(!complete&&performance.now()<until);return complete}get isMoving(){return this.viewer.player.playing||this.
viewer.isHeld}get leavesOut(){return this.isCoarse&&this.isMoving}arrange(shown){this.isRefined=!1,this.layers=this.content.
arrange(shown)}draft(program,shown,moving){let{width,height}=this.canvas,samples=Number(this.viewer.settings.samples),crowd=moving?
this.graphics.waiting.size+1:1;this.arrange(shown);let price=program.price*this.factor(samples),isPlaying=this.viewer.player.
playing&&!this.viewer.isHeld,time=movingTime(price,this.fixed,width*height,samples,isPlaying),budget=Math.max(time/crowd,
MOVING_LEAST_MS),best=quality(price,this.fixed,width*height,samples,budget),w=Math.max(Math.round(width*best.scale),1),h=Math.
max(Math.round(height*best.scale),1);this.draftVersion=this.version;let reuse=best.scale<1?this.reuse():null;if(!reuse?.
covers){let started=performance.now();this.place(shown,w,h);let summed=this.sum(program,shown,0,h,best.samples);this.show(
shown,!1,best.samples),this.fixed+=.5*(clamp(performance.now()-started-summed,.5,500)-this.fixed)}reuse&&this.pen&&(this.
pen.imageSmoothingEnabled=!reuse.shifts,this.pen.setTransform(...reuse.matrix),replace(this.pen,this.last),this.pen.setTransform(
1,0,0,1,0,0)),this.isCoarse=best.scale<1||best.samples<samples;let isWhole=!this.isCoarse&&!this.content.smooth;return isWhole&&
this.complete(),this.drawLines(shown),isWhole&&!this.isRefined}strip(program,shown){let{width,height}=this.canvas,samples=Number(
this.viewer.settings.samples);if(this.rowsDone>=height&&(this.rowsDone=0),this.rowsDone===0&&(this.arrange(shown),this.isRefined))
return!1;this.place(shown,width,height);let price=program.price*this.factor(samples),rows=Math.min(height-this.rowsDone,
rowsIn(STRIP_MS,price,width,samples));return this.sum(program,shown,this.rowsDone,rows,samples),this.rowsDone+=rows,this.
rowsDone<height?!1:(this.show(shown,this.content.smooth,samples),this.complete(),this.drawLines(shown),!0)}drawLines(shown){
let{front,frontPen,graphics}=this,{camera,ratio}=this.viewer,{scene}=this.content,{width,height}=this.canvas;if(!scene||
!camera||!frontPen)return;let{earth,bodies}=scene;if(!earth.lines.length&&!bodies.labels.length)return;let{state,aspect}=camera,
look=JSON.stringify([state,aspect,width,height,earth.lines,earth.version]);if(look!==this.frontLook){let{anchor}=this.viewer.
view(shown,ratio),{canvas}=graphics;canvas.width<width&&(canvas.width=width),canvas.height<height&&(canvas.height=height),
front.width=width,front.height=height,earth.drawLines({camera,anchor,width,height,ratio},()=>{let top=canvas.height-height;
frontPen.drawImage(canvas,0,top,width,height,0,0,width,height)}),bodies.drawLabels(frontPen,{camera,anchor,width,height,
ratio}),this.frontLook=look}this.pen?.drawImage(front,0,0)}complete(){let{camera,player}=this.viewer;this.rowsDone=this.
canvas.height,this.isCoarse=!1,this.draftVersion=this.version,replace(this.lastPen,this.canvas),camera&&!player.playing&&
(this.lastCamera=new Camera(camera.state,camera.limits,camera.flat,camera.aspect))}reuse(){let{lastCamera}=this,{camera}=this.
viewer,{scene}=this.content;if(!scene?.header.geometry.planar||!camera||!lastCamera||!camera.state.parallel||!lastCamera.
state.parallel)return null;let{geometry}=scene.header,focus=subtract2(camera.state.focal_point,geometry.center),anchor=toFrame(
geometry.frame,focus),[before,now]=[lastCamera,camera].map(view=>projection(geometry,view,anchor));return reused(before,
now,this.canvas.width,this.canvas.height)}factor(samples){let{settings,player}=this.viewer;return settings.motion!=="off"||
player.varies&&player.playing?motionFactor(samples):1}placeAt(shown,x,y){let{places}=this.content;return this.place(shown,
places?.width||this.canvas.width,places?.height||this.canvas.height),places?.at(x,y)??null}place(shown,width,height){let{
viewer,layers,content}=this,{camera}=viewer;if(!camera||!layers.length)return;let{anchor}=viewer.view(shown,this.density(
height));content.places?.draw({layers,camera,anchor,width,height})}density(height){return this.viewer.ratio*height/this.
canvas.height}sum(program,shown,top,rows,samples){let{places,scene}=this.content,{camera}=this.viewer;if(!places||!scene||
!camera)return 0;let{width,height}=places,view=this.viewer.view(shown,this.density(height)),draft=this.isDraft(height,samples),
valuesOf=layer=>(layer.bindNodes(view.anchor),layer.bindTextures(shown[0],shown[1]),{...this.values(layer,scene,camera,view,
samples,draft),...rays(layer.header.geometry,camera,view.anchor,width,height)});program.warm||places.sum(program,top,1,valuesOf),
program.warm=!0;let started=performance.now();places.sum(program,top,rows,valuesOf);let spent=performance.now()-started;
return program.price=learnedPrice(program.price,spent,width*rows,samples,this.factor(samples)),spent}isDraft(height,samples){
return samples!==this.viewer.settings.samples||height!==this.canvas.height}colour(places,shown,samples){let{scene}=this.
content,{camera}=this.viewer;if(!scene||!camera)return;let{height}=places,view=this.viewer.view(shown,this.density(height)),
draft=this.isDraft(height,samples),valuesOf=layer=>this.values(layer,scene,camera,view,samples,draft),grain=isEven(scene.
header,this.viewer.settings)?Number(valuesOf(scene).u_grain):null;places.colour(grain,valuesOf)}show(shown,smooth,samples){
let{places}=this.content;if(!places)return;this.colour(places,shown,samples);let{width,height}=places,{canvas}=this.graphics;
canvas.width<width&&(canvas.width=width),canvas.height<height&&(canvas.height=height);let most=smooth?SMOOTH_ROWS:height;
for(let bottom=0;bottom<height;bottom+=most)this.render(shown,bottom,Math.min(most,height-bottom),smooth)}render(shown,bottom,rows,smooth){
let{graphics,viewer}=this,{camera}=viewer,{scene,places}=this.content;if(!camera||!scene||!places)return;let gl=graphics.
context,{width,height}=places,view=viewer.view(shown,this.density(height));smooth?graphics.bindSmooth(width,rows):gl.bindFramebuffer(
gl.FRAMEBUFFER,null),gl.viewport(0,-bottom,width,height),gl.enable(gl.SCISSOR_TEST),gl.scissor(0,0,width,rows),gl.enable(
gl.DEPTH_TEST),gl.depthFunc(gl.LESS),gl.disable(gl.BLEND),gl.disable(gl.CULL_FACE);let[r,g,b]=scene.header.background??[
1,1,1];gl.clearColor(r,g,b,viewer.isClear?0:1),gl.clear(gl.COLOR_BUFFER_BIT|gl.DEPTH_BUFFER_BIT);let around2={camera,anchor:view.
anchor,width,height,ratio:viewer.ratio};scene.earth.drawGround(around2);let{bodies}=scene;bodies.draw(around2,"opaque"),
bodies.seeThrough(()=>{if(!smooth)return places.show(scene.programs("surface"));let matrix=projection(scene.header.geometry,
camera,view.anchor);places.triangles(scene.programs("smooth"),matrix,view.anchor,{u_bottom:bottom})}),this.drawArrows(shown,
view,width,height),bodies.draw(around2,"clear"),scene.marks.draw({...around2,ratio:view.density},viewer.settings,shown),
smooth&&graphics.copySmooth(width,rows),this.copy(width,height,bottom,rows)}drawArrows(shown,view,width,height){let{camera,
settings}=this.viewer,{scene}=this.content;if(!scene||!camera||!hasArrows(scene.header,settings))return;let seen={...camera.
sight(height/view.density),planes:camera.planes},draft=height!==this.canvas.height,layers=this.layers.map(layer=>layer.scene);
for(let[layer,placed]of scene.arrows.share(seen,settings,layers)){let{arrows,header}=layer,program=arrows.program(settings,
isNear(header,settings,view));if(!program||!placed.length)continue;layer.bindTextures(shown[0],shown[1]);let painted=layer.
scalarParts(shown[0],shown[1]),values=this.values(layer,scene,camera,view,Number(settings.samples),draft);arrows.draw(program,
placed,painted,view.anchor,{...values,u_picture:[width,height]})}}values({header},{bodies},camera,view,samples,draft){let{
settings}=this.viewer,{columns,rows}=header.geometry,plain=header.scalars.name!==null&&hasArrows(header,settings)&&settings.
arrow_color==="scalars";return{...uniforms(header,{...settings,samples},view),...draft?draftUniforms(settings,samples,view.
density):{},u_matrix:projection(header.geometry,camera,view.anchor),u_mapped:header.scalars.name!==null&&!plain,u_plain:plain,
u_flat:!!header.scalars.flat,u_padding:[columns.before,rows.before],u_colour:header.colour,u_lit:header.lighting,u_ground:header.
background??[1,1,1],u_opacity:bodies.areBehind?1:header.opacity,u_toEye:toFrame(header.geometry.frame,scale2(camera.axes[2],
-1))}}copy(width,height,bottom,rows){let{pen}=this;if(!pen)return;let{canvas}=this.graphics,first=canvas.height-rows,[w,
scaled]=[this.canvas.width,this.canvas.height/height];if(pen.imageSmoothingEnabled=w!==width||scaled!==1,pen.imageSmoothingEnabled){
let{coarse,coarsePen}=this;coarse.width=width,coarse.height=rows,coarsePen?.drawImage(canvas,0,first,width,rows,0,0,width,
rows),[canvas,first]=[coarse,0]}let to=(height-bottom-rows)*scaled;pen.clearRect(0,to,w,rows*scaled),pen.drawImage(canvas,
0,first,width,rows,0,to,w,rows*scaled)}},GREATEST_GROWTH=4,LEAST_GROWTH=.3,ROUNDING3=1e-6,product=(a,b)=>multiply([0,0,0,
0,0,0],a,b),inverse=a=>invert([0,0,0,0,0,0],a);function reused(before,now,width,height){let[w,h]=[width/2,height/2],toPixels=m=>product(
[w,0,0,-h,w,h],[m[0],m[1],m[4],m[5],m[12],m[13]]),matrix=product(toPixels(now),inverse(toPixels(before))),area=Math.abs(
determinant(matrix));if(!(area>LEAST_GROWTH**2&&area<GREATEST_GROWTH**2))return null;let[a,b,c,d,e,f]=inverse(matrix),isInside=([
x,y])=>Math.abs((a*x+c*y+e)/w-1)<1+ROUNDING3&&Math.abs((b*x+d*y+f)/h-1)<1+ROUNDING3,covers=[[0,0],[width,0],[0,height],[
width,height]].every(isInside),[xx,xy,yx,yy]=matrix,shifts=Math.abs(xx-1)+Math.abs(yy-1)+Math.abs(xy)+Math.abs(yx)<ROUNDING3;
if(shifts)for(let n of[4,5])matrix[n]=Math.round(matrix[n]);return{matrix,covers,shifts}}var CORNERS=4,ArrowSeeds=class{surface;limits;sums;whole=[[]];last=null;constructor(surface,limits){this.surface=surface,
this.limits=limits;let sum=0;this.sums=Float64Array.from({length:surface.corners.length/CORNERS},(_,cell)=>sum+=this.area(
wholeCell(cell)))}seen(view,spacing){return(!this.last||!this.covers(this.last.wanted,[view,spacing]))&&(this.last={wanted:[
view,spacing],seeds:this.make([view,spacing])}),this.last.seeds}position(cell,place){let{nodes,corners}=this.surface;return between2(
nodes,corners.subarray(CORNERS*cell,CORNERS*(cell+1)),place,3)}point(position){let{frame,center}=this.surface.geometry;return add(
fromFrame(frame,position),center)}covers([last,least],[view,spacing]){let{closer}=this.limits;return this.cornersOf(view).
every(point=>closer*least*pixelAt(last,point)<=spacing*pixelAt(view,point)&&this.sees(last,point,0))}cornersOf({planes}){
let{center,extent}=this.surface.geometry,normal=n=>planes[n].slice(0,3),away=cross2(normal(0),normal(2)),reach=.5*extent*
length2(away);return[0,1].flatMap(side=>[2,3].flatMap(end=>[-1,1].map(sign=>[side,end,sign]))).map(([side,end,sign])=>{let[
a,b]=[normal(side),normal(end)],sum=add(scale2(cross2(b,away),-planes[side][3]),cross2(away,a),-planes[end][3]),both=cross2(
a,b);return scale2(add(sum,both,dot2(away,center)+sign*reach),1/dot2(both,away))})}sees(view,point,reach){let slack=reach+
this.limits.around*view.pixels*pixelAt(view,point);return view.planes.every(p=>dot2(p,point)+p[3]>=-slack*length2(p))}make(wanted){
let[view,spacing]=wanted,{limits,sums,whole}=this,{extent,center}=this.surface.geometry,total2=sums[sums.length-1]??0,nearest3=view.
eye?Math.max(length2(subtract2(center,view.eye))-.5*extent,0):1,least=limits.closer*spacing*pixelOf(view,nearest3),radius=extent,
seeds=whole[0],parts=null;for(let octave=0;octave<limits.mostOctaves;octave+=1){let area=limits.candidateArea*radius**2;
if(total2<=limits.mostCandidates*area)whole[octave+1]??=this.grown(seeds,this.spread(octave,area),radius),seeds=whole[octave+
1];else{parts??=Array.from(sums,(_,cell)=>wholeCell(cell)),parts=this.divided(parts.filter(part=>this.isNeeded(part,wanted,
radius)),area);let candidates=parts.flatMap(part=>{let key=mixed(part.key+octave);return shareOf2(key)*area<this.area(part)?
[this.candidate(part,key)]:[]});if(seeds=this.grown(seeds,candidates,radius),!parts.length)break}if(radius<=least)break;
radius*=limits.octave}return seeds.filter(seed=>{let point=this.point(seed.position);return seed.radius>=limits.closer*spacing*
pixelAt(view,point)&&this.sees(view,point,0)})}spread(octave,area){let{sums}=this,base=mixed(octave+OCTAVE_PRIME),cell=0;
return Array.from({length:Math.floor((sums[sums.length-1]??0)/area)},(_,number)=>{let key=mixed(base+number),at=(number+
shareOf2(key))*area;for(;cell<sums.length-1&&sums[cell]<=at;)cell+=1;return this.candidate(wholeCell(cell),key)})}candidate({
cell,low,size},key){let first=mixed(key+OCTAVE_PRIME),second=mixed(first+OCTAVE_PRIME),place=[low[0]+size[0]*shareOf2(first),
low[1]+size[1]*shareOf2(second)];return{cell,place,position:this.position(cell,place),radius:1/0}}grown(seeds,candidates,least){
let most=least/this.limits.octave,near=new Neighbours(most);for(let seed of seeds)near.add(seed.position);for(let seed of candidates)
seed.radius=near.distance(seed.position);let order=candidates.filter(({radius})=>radius>=least).sort((a,b)=>b.radius-a.radius),
fresh=new Neighbours(most),taken=order.filter(seed=>(seed.radius=Math.min(seed.radius,fresh.distance(seed.position)),seed.
radius<least?!1:(fresh.add(seed.position),!0)));return[...seeds,...taken]}isNeeded(part,[view,spacing],radius){let{octave,
closer,aroundRadii}=this.limits,{cell,low,size}=part,middle=this.point(this.position(cell,[low[0]+.5*size[0],low[1]+.5*size[1]])),
[a,b]=this.sides(part),reach=.5*(length2(a)+length2(b)),away=Math.max(awayOf(view,middle)-reach,0);return!(radius<octave*
closer*spacing*pixelOf(view,away))&&this.sees(view,middle,reach+aroundRadii*radius)}divided(parts,area){let large=parts.
filter(part=>this.area(part)>area);if(!large.length)return parts;let halves=large.map(part=>{let[a,b]=this.sides(part),axis=length2(
b)>length2(a)?1:0,size=[...part.size];size[axis]*=.5;let low=[...part.low];return low[axis]+=size[axis],[{...part,size,key:mixed(
part.key+OCTAVE_PRIME)},{...part,size,low,key:mixed(part.key+SEED_PRIME)}]}),small=parts.filter(part=>this.area(part)<=area);
return this.divided([...small,...halves.map(([first])=>first),...halves.map(([,second])=>second)],area)}sides({cell,low,
size}){let at=(i,j)=>this.position(cell,[low[0]+size[0]*i,low[1]+size[1]*j]);return[subtract2(at(1,.5),at(0,.5)),subtract2(
at(.5,1),at(.5,0))]}area(part){return length2(cross2(...this.sides(part)))}};function between2(nodal,corners,[i,j],size){
let shares2=[(1-j)*(1-i),(1-j)*i,j*(1-i),j*i],result2=new Array(size).fill(0);for(let n=0;n<CORNERS;n+=1)for(let k=0;k<size;k+=
1)result2[k]+=shares2[n]*nodal[size*corners[n]+k];return result2}var Neighbours=class{most;cubes=new Map;constructor(most){
this.most=most}cube(point){return point.map(x=>Math.floor(x/this.most))}add(point){let key=cubeKey(...this.cube(point)),
there=this.cubes.get(key);there?there.push(point):this.cubes.set(key,[point])}distance(point){let[i,j,k]=this.cube(point),
nearest3=this.most;for(let n=0;n<27;n+=1){let key=cubeKey(i+n%3-1,j+Math.floor(n/3)%3-1,k+Math.floor(n/9)-1);for(let other of this.
cubes.get(key)??[])nearest3=Math.min(nearest3,length2(subtract2(point,other)))}return nearest3}},OCTAVE_PRIME=2654435769,
SEED_PRIME=2246822507,HASH_FACTORS=[739982445,695872825],HASH_SHIFT=15;function cubeKey(i,j,k){return Math.imul(i,2376512323)^
Math.imul(j,3625334849)^Math.imul(k,3407524639)}function mixed(key){let hash=key>>>0;for(let factor of HASH_FACTORS)hash=
Math.imul(hash^hash>>>HASH_SHIFT,factor)>>>0;return(hash^hash>>>HASH_SHIFT)>>>0}var shareOf2=key=>key/2**32;function wholeCell(cell){
return{cell,low:[0,0],size:[1,1],key:mixed(cell)}}var awayOf=({eye},point)=>eye?length2(subtract2(point,eye)):1,pixelOf=({
halfHeight,pixels},away)=>2*halfHeight/pixels*away,pixelAt=(view,point)=>pixelOf(view,awayOf(view,point));var SIZES=[[0,3],[1,2],[2,3],[3,2],[4,3],[5,1]],FLOAT_BYTES=4,STRIDE=SIZES.reduce((sum,[,size])=>sum+size,0),isEqual=(a,b)=>a.
length===b.length&&a.every((each,n)=>each===b[n]),levelOf=({tile})=>tile?.[0]??1/0,Arrows=class{graphics;header;parts;seeds=null;array=null;buffer=null;known=null;last=null;drawn=null;constructor(graphics,header,parts){
this.graphics=graphics,this.header=header,this.parts=parts}program(settings,isClose){let{shaders,geometry}=this.header;if(!hasArrows(
this.header,settings))return null;let variant=isClose&&!geometry.triangles?["FLOWTEX_CELLS"]:[];return this.graphics.programs.
get(shaders.arrowVertex,shaders.arrowFragment,...variant)}share(view,settings,layers){let{header,last}=this;this.seeds??=
new ArrowSeeds(this.surface,header.constants.arrows);let seeds=this.seeds.seen(view,arrowDistance(header,settings));if(last?.
seeds===seeds&&isEqual(layers,last.layers))return last.shared;let{corners}=this.surface,whole=seeds.map(({cell,place,radius})=>{
let around2=corners.subarray(4*cell,4*cell+4);return{corners:around2,place,radius,cell:header.geometry.triangles?cell:around2[0]}}),
shared2=new Map(layers.map(layer=>[layer,[]])),finest=[...layers].sort((a,b)=>levelOf(a)-levelOf(b));for(let seed of whole)
for(let layer of finest){let placed=layer.tile?this.inTile(seed,layer,layer.tile):seed;if(placed){shared2.get(layer)?.push(
placed);break}}return this.last={seeds,layers,shared:shared2},shared2}draw(program,placed,painted,anchor,values){let{graphics}=this,
gl=graphics.context;this.array??=this.make(),gl.bindVertexArray(this.array);let{name,low,high,log}=this.header.scalars,digests=painted.
map(part=>this.parts.get(part)?.digest),key=JSON.stringify([anchor,painted,digests,name,low,high,log]);(this.drawn?.placed!==
placed||this.drawn.key!==key)&&(gl.bindBuffer(gl.ARRAY_BUFFER,this.buffer),gl.bufferData(gl.ARRAY_BUFFER,this.numbers(placed,
painted,anchor),gl.DYNAMIC_DRAW),this.drawn={placed,key}),graphics.programs.use(program,values),gl.enable(gl.BLEND),gl.blendFuncSeparate(
gl.SRC_ALPHA,gl.ONE_MINUS_SRC_ALPHA,gl.ZERO,gl.ONE),gl.depthMask(!1),gl.drawArraysInstanced(gl.TRIANGLE_STRIP,0,2*(this.
header.constants.arrows.pieces+1),placed.length),gl.depthMask(!0),gl.disable(gl.BLEND),gl.bindVertexArray(null)}forget(){
this.known=this.seeds=this.last=this.drawn=null}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("V\
ertexArray",this.array),this.array=this.buffer=null,this.forget()}inTile({corners,place,radius},layer,[level,row2,column]){
let{geometry,pyramid,mesh}=this.header;if(!pyramid||geometry.triangles)return null;let side=mesh.tileCells*pyramid.tileBlocks,
[rows,columns]=layer.header.geometry.shape,width=geometry.shape[1],line=(at,axis,tile,cells)=>{let nodes=pyramid.shapes[0][axis],
own=levelIndex(fullIndex(at,pyramid.depth,nodes),level,nodes)-tile*side,cell=Math.min(Math.max(Math.floor(own),0),cells-
1);return own<0||own>cells?null:[cell,own-cell]},i=line(corners[0]%width+place[0],1,column,columns-1),j=line(Math.floor(
corners[0]/width)+place[1],0,row2,rows-1);if(!i||!j||layer.parts.get("cells")?.data[j[0]*(columns-1)+i[0]]===0)return null;
let low=j[0]*columns+i[0];return{corners:[low,low+1,low+columns,low+columns+1],place:[i[1],j[1]],radius,cell:low}}make(){
let gl=this.graphics.context,array=this.graphics.counted(gl.createVertexArray());this.buffer=this.graphics.counted(gl.createBuffer()),
gl.bindVertexArray(array),gl.bindBuffer(gl.ARRAY_BUFFER,this.buffer);let offset=0;for(let[attribute,size]of SIZES)gl.enableVertexAttribArray(
attribute),gl.vertexAttribPointer(attribute,size,gl.FLOAT,!1,STRIDE*FLOAT_BYTES,offset),gl.vertexAttribDivisor(attribute,
1),offset+=size*FLOAT_BYTES;return array}numbers(placed,painted,anchor){let{geometry,scalars}=this.header,steps=painted.
map(name=>this.parts.get(name)?.data??new Float32Array),colour=shares(steps,scalars),nodes=this.nodes,coordinate=geometry.
triangles?null:coordinates(geometry);return Float32Array.from(placed.flatMap(({corners,place,radius,cell})=>{let[i,j]=place,
[a,b,c,d]=Array.from(corners,n=>[...nodes.subarray(3*n,3*n+3)]),across=cross2(subtract2(add(b,d),add(a,c)),subtract2(add(
c,d),add(a,b)));return[...subtract2(between2(nodes,corners,place,3),anchor),...coordinate?between2(coordinate,corners,place,
2):[i*(1-j),j],...unit(across),...scalars.flat?colour.subarray(2*cell,2*cell+2):between2(colour,corners,place,2),...Array.
from(corners).slice(0,3),radius]}))}get nodes(){return this.parts.get("position")?.data??new Float32Array}get surface(){
return this.known??={geometry:this.header.geometry,nodes:this.nodes,corners:this.corners()}}corners(){let{geometry}=this.
header,[rows,columns]=geometry.shape,result2=[];if(geometry.triangles){let nodes=this.parts.get("triangles")?.data??[];for(let n=0;n<
nodes.length;n+=3)result2.push(nodes[n],nodes[n+1],nodes[n+2],nodes[n+2]);return Uint32Array.from(result2)}let cells=this.
parts.get("cells")?.data;for(let n=0;n<(rows-1)*(columns-1);n+=1){if(cells&&!cells[n])continue;let low=n+Math.floor(n/(columns-
1));result2.push(low,low+1,low+columns,low+columns+1)}return Uint32Array.from(result2)}};var BODY_PARTS=["bodyPoints","bodyNormals","bodyColours","bodyFaces","bodyPieces"],LIGHTS=8,[ENDS_BYTES,COLOURS_BYTES]=[
24,8],BEHIND=[1,2],PLATE_MARGIN=.2;function atEnds(values,pieces,size){let Type=values.constructor,ends2=new Type(size*pieces.
length);for(let n=0;n<pieces.length;n+=1)for(let k=0;k<size;k+=1)ends2[size*n+k]=values[size*pieces[n]+k];return ends2}function lightUniforms({
geometry,bodies},camera){let[right,up,ahead]=camera.axes,lights=(bodies?.lights??[]).slice(0,LIGHTS),ways=lights.map(({way,
turns})=>{let turned2=add(add(scale2(right,way[0]),up,way[1]),ahead,-way[2]);return toFrame(geometry.frame,turns?turned2:
way)}),padded=vectors=>Float32Array.from({length:3*LIGHTS},(_,n)=>vectors.flat()[n]??0);return{u_lightWays:padded(ways),
u_lightColours:padded(lights.map(({color})=>color))}}var Bodies=class{graphics;header;parts;drawn=null;constructor(graphics,header,parts){
this.graphics=graphics,this.header=header,this.parts=parts}get labels(){return this.header.bodies?.labels??[]}get runs(){
let{bodies}=this.header;return bodies&&BODY_PARTS.every(name=>this.parts.has(name))?bodies.runs:[]}get areBehind(){return this.
runs.length>0&&this.header.opacity<1}get programs(){let{programs}=this.graphics,{bodyVertex,bodyFragment,lineVertex,lineFragment}=this.
header.shaders;return[programs.get(bodyVertex,bodyFragment),programs.get(lineVertex,lineFragment,"FLOWTEX_BODY"),programs.
get(bodyVertex,bodyFragment,"FLOWTEX_HIDING")]}get isReady(){return!this.runs.length||this.programs.every(({ready})=>ready)}dispose(){
let{drawn,graphics}=this;if(drawn){for(let buffer of drawn.buffers)graphics.free("Buffer",buffer);graphics.free("VertexA\
rray",drawn.faces),graphics.free("VertexArray",drawn.pieces),this.drawn=null}}seeThrough(draw,mixes=this.areBehind){if(!this.
runs.length)return draw();let gl=this.graphics.context;gl.enable(gl.POLYGON_OFFSET_FILL),gl.polygonOffset(BEHIND[0],BEHIND[0]),
mixes&&(gl.enable(gl.BLEND),gl.blendColor(0,0,0,this.header.opacity),gl.blendFuncSeparate(gl.CONSTANT_ALPHA,gl.ONE_MINUS_CONSTANT_ALPHA,
gl.ZERO,gl.ONE)),draw(),gl.disable(gl.BLEND),gl.disable(gl.POLYGON_OFFSET_FILL)}draw({camera,anchor,width,height,ratio},kind){
let isClear=kind==="clear",runs=this.runs.filter(({clear})=>clear===isClear);if(!runs.length)return;let{header,graphics}=this,
{geometry}=header,gl=graphics.context,[faces,pieces]=this.programs,drawn=this.drawn??=this.make(),matrix=projection(geometry,
camera,anchor),[x,y,z,w]=camera.eye,eye=toFrame(geometry.frame,subtract2([x,y,z],scale2(geometry.center,w)));isClear&&(gl.
enable(gl.BLEND),gl.blendFuncSeparate(gl.SRC_ALPHA,gl.ONE_MINUS_SRC_ALPHA,gl.ZERO,gl.ONE),gl.depthMask(!1)),graphics.programs.
use(faces,{u_matrix:matrix,u_anchor:anchor,u_eye:[...subtract2(eye,scale2(anchor,w)),w],...lightUniforms(header,camera)}),
gl.bindVertexArray(drawn.faces),gl.enable(gl.POLYGON_OFFSET_FILL),gl.polygonOffset(BEHIND[1],BEHIND[1]);for(let{faces:[first,
count2],ambient,diffuse}of runs)count2&&(graphics.programs.use(faces,{u_ambient:ambient,u_diffuse:diffuse}),gl.drawElements(
gl.TRIANGLES,3*count2,gl.UNSIGNED_INT,12*first));gl.disable(gl.POLYGON_OFFSET_FILL);let around2={u_matrix:matrix,u_anchor:anchor,
u_picture:[width,height],u_horizon:[0,0,0,1]};graphics.programs.use(pieces,around2),gl.bindVertexArray(drawn.pieces);for(let{
pieces:[first,count2],width:thickness}of runs)if(count2){graphics.programs.use(pieces,{u_width:thickness*ratio});for(let[
buffer,size,type,bytes,at]of[[drawn.ends,3,gl.FLOAT,ENDS_BYTES,0],[drawn.colours,4,gl.UNSIGNED_BYTE,COLOURS_BYTES,2]]){gl.
bindBuffer(gl.ARRAY_BUFFER,buffer);for(let end of[0,1])gl.vertexAttribPointer(at+end,size,type,size===4,bytes,bytes*(first+
end/2))}gl.drawArraysInstanced(gl.TRIANGLE_STRIP,0,4,count2)}gl.bindVertexArray(null),gl.depthMask(!0),gl.disable(gl.BLEND)}hide(matrix,anchor){
let{runs,graphics}=this;if(!runs.length)return;let gl=graphics.context,drawn=this.drawn??=this.make();gl.enable(gl.POLYGON_OFFSET_FILL),
gl.polygonOffset(BEHIND[1],BEHIND[1]),graphics.programs.use(this.programs[2],{u_matrix:matrix,u_anchor:anchor}),gl.bindVertexArray(
drawn.faces);for(let{faces:[first,count2],clear}of runs)clear||gl.drawElements(gl.TRIANGLES,3*count2,gl.UNSIGNED_INT,12*
first);gl.disable(gl.POLYGON_OFFSET_FILL),gl.bindVertexArray(null)}drawLabels(pen,{camera,anchor,width,height,ratio}){let{
geometry}=this.header,m=projection(geometry,camera,anchor);for(let{text,position,size,color,plate}of this.labels){let p=subtract2(
toFrame(geometry.frame,subtract2(position,geometry.center)),anchor),[x,y,,w]=[0,1,2,3].map(k=>m[k]*p[0]+m[4+k]*p[1]+m[8+
k]*p[2]+m[12+k]);if(w<=0)continue;let[left,bottom]=[(.5+.5*x/w)*width,(.5-.5*y/w)*height],letters=size*ratio,margin=PLATE_MARGIN*
letters;pen.font=`600 ${letters}px system-ui, sans-serif`,pen.textBaseline="middle";let[wide,high]=[pen.measureText(text).
width+2*margin,letters+2*margin];pen.fillStyle=css(plate),pen.beginPath(),pen.roundRect(left,bottom-high,wide,high,margin),
pen.fill(),pen.fillStyle=css(color),pen.fillText(text,left+margin,bottom-.5*high)}}make(){let{graphics,parts}=this,gl=graphics.
context,[points,normals,colours,corners,pieces]=BODY_PARTS.map(name=>parts.get(name)?.data??[]),array=()=>{let made=graphics.
counted(gl.createVertexArray());return gl.bindVertexArray(made),made},buffer=(data,target=gl.ARRAY_BUFFER)=>{let made=graphics.
counted(gl.createBuffer());return gl.bindBuffer(target,made),gl.bufferData(target,data,gl.STATIC_DRAW),made},faces=array(),
buffers=[[points,3,gl.FLOAT],[normals,3,gl.BYTE],[colours,4,gl.UNSIGNED_BYTE]].map(([data,size,type],n)=>{let made=buffer(
data);return gl.enableVertexAttribArray(n),gl.vertexAttribPointer(n,size,type,type!==gl.FLOAT,0,0),made});buffers.push(buffer(
corners,gl.ELEMENT_ARRAY_BUFFER));let lines=array(),ends2=buffer(atEnds(points,pieces,3)),paints=buffer(atEnds(colours,pieces,
4));for(let n=0;n<4;n+=1)gl.enableVertexAttribArray(n),gl.vertexAttribDivisor(n,1);return gl.bindVertexArray(null),{faces,
pieces:lines,ends:ends2,colours:paints,buffers:[...buffers,ends2,paints]}}};function css([r,g,b,opacity=1]){return`rgb(${[
r,g,b].map(c=>Math.round(255*c)).join(" ")} / ${opacity})`}var GROUND=["land","missing"],LAND="land",LIGHT_FROM=.18;function missingColour({background,earth}){let ground=background??
[1,1,1],share=earth?.missingShare??0,ink=dot2(ground.map(value=>value**2.2),[.2126,.7152,.0722])>=LIGHT_FROM?0:1;return ground.
map(value=>value*(1-share)+ink*share)}function groundKinds(header){let{earth}=header,land=earth?.land;return land?earth.
kinds.map(name=>({name,color:name===LAND?land:missingColour(header),isGround:!0})):[]}var BREAK=1e30,STEPS2=65535,GROUP=256;function linesOf(steps,{low,size}){let lines=[],place=[0,0,0];for(let n=0;n<steps.
length;n+=4){steps[n+3]&&lines.push([]);let point=place.map((_,k)=>(place[k]=place[k]+steps[n+k]&STEPS2,low[k]+place[k]/
STEPS2*size[k]));lines[lines.length-1].push(point)}return lines}function thinned(lines,spacing){return spacing?lines.flatMap(
line=>{let along2=0,kept=line.filter((point,n)=>{let before=along2;return n&&(along2+=Math.hypot(...point.map((x,k)=>x-line[n-
1][k]))),Math.floor(along2/spacing)>Math.floor(before/spacing)||n===0||n===line.length-1});return along2<spacing?[]:[kept]}):
lines}function linePoints(lines,anchor){let size=lines.reduce((count2,line)=>count2+line.length+1,0),points=new Float32Array(
3*size).fill(BREAK),n=0;for(let line of lines){n+=3;for(let point of line)for(let k=0;k<3;k+=1)points[n++]=point[k]-anchor[k]}
return points}function pieceGroups(points){let groups=[],pieces=points.length/3-1;for(let first=0;first<pieces;first+=GROUP){
let count2=Math.min(GROUP,pieces-first),[low,high]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let n=3*first;n<3*(first+count2+
1);n+=1)points[n]!==Math.fround(BREAK)&&(low[n%3]=Math.min(low[n%3],points[n]),high[n%3]=Math.max(high[n%3],points[n]));
let middle=low.map((least,k)=>(least+high[k])/2),radius=Math.hypot(...low.map((least,k)=>(high[k]-least)/2));groups.push(
{first,count:count2,middle,radius})}return groups}function visibleRuns(groups,planes){let runs=[];for(let{first,count:count2,
middle:[x,y,z],radius}of groups){let isOut=([a,b,c,d])=>a*x+b*y+c*z+d<-radius*Math.hypot(a,b,c);if(planes.some(isOut))continue;
let last=runs[runs.length-1];last&&last[0]+last[1]===first?last[1]+=count2:runs.push([first,count2])}return runs}var POINT_BYTES=12,
PIECE_ENDS=2;function groundAt({earth,geometry},camera,x,y){if(!earth)return null;if(earth.map){let place=pointInPlane(geometry,
camera,x,y),[x0,y0,x1,y1]=earth.map;return place[0]>=x0&&place[0]<=x1&&place[1]>=y0&&place[1]<=y1?place:null}let[start,along2]=camera.
ray(x,y),nearest3=dot2(start,along2),square=nearest3**2-dot2(start,start)+earth.radius**2,depth=-nearest3-Math.sqrt(square);
return depth>0?add(start,along2,depth):null}var EarthLayer=class{version=0;graphics;header;parts;drawn=new Map;constructor(graphics,header,parts){
this.graphics=graphics,this.header=header,this.parts=parts}forget(name){this.version+=1;for(let each of name==="position"?
GROUND:[name])this.drop(each)}dispose(){for(let name of[...this.drawn.keys()])this.drop(name)}drop(name){let drawn=this.
drawn.get(name);if(drawn){for(let buffer of drawn.buffers)this.graphics.free("Buffer",buffer);this.graphics.free("Vertex\
Array",drawn.array),this.drawn.delete(name)}}get lines(){let{earth}=this.header;return earth?EARTH_LINES.filter(name=>earth[name]&&
this.parts.has(name)):[]}drawLines(view,take){let{header,graphics}=this,{earth,shaders}=header,program=graphics.programs.
get(shaders.lineVertex,shaders.lineFragment);if(!earth||!program.ready)return;let gl=graphics.context,{camera,anchor,width,
height,ratio}=view;gl.bindFramebuffer(gl.FRAMEBUFFER,null),gl.viewport(0,0,width,height),gl.enable(gl.SCISSOR_TEST),gl.scissor(
0,0,width,height),gl.disable(gl.DEPTH_TEST),gl.enable(gl.BLEND),gl.blendEquation(gl.MAX),gl.clearColor(0,0,0,0);let horizon=this.
horizon(camera),local=[...camera.planes,...horizon?[horizon]:[]].map(plane=>this.localPlane(plane,anchor)),pixel=2*camera.
height*ratio/height,wider=clamp(Math.sqrt(height/ratio/earth.usualHeight),...earth.widthRange),most=earth.spacingPixels*
pixel,spacing=earth.spacings.find(each=>each<=most)??0;for(let{option,color,opacity,width:thickness}of earth.strokes){if(!this.
lines.includes(option))continue;gl.clear(gl.COLOR_BUFFER_BIT);let drawn=this.take(option,anchor,()=>this.linesOf(option,
anchor,spacing),spacing);graphics.programs.use(program,{u_matrix:projection(header.geometry,camera,anchor),u_picture:[width,
height],u_width:thickness*wider*ratio,u_lineColour:[...color,opacity],u_horizon:horizon?local[local.length-1]:[0,0,0,1]}),
gl.bindVertexArray(drawn.array),gl.bindBuffer(gl.ARRAY_BUFFER,drawn.buffers[0]);for(let[first,count2]of visibleRuns(drawn.
groups,local)){for(let n=0;n<PIECE_ENDS;n+=1)gl.vertexAttribPointer(n,3,gl.FLOAT,!1,POINT_BYTES,(first+n)*POINT_BYTES);gl.
drawArraysInstanced(gl.TRIANGLE_STRIP,0,4,count2)}take()}gl.bindVertexArray(null),gl.blendEquation(gl.FUNC_ADD),gl.disable(
gl.BLEND)}get isReady(){let{lineVertex,lineFragment}=this.header.shaders,{earth}=this.header;return earth?.land&&(earth.
map===null&&earth.below&&!this.groundProgram("FLOWTEX_GLOBE").ready||this.hasCells&&!this.groundProgram(...this.roundness).
ready)?!1:!this.lines.length||this.graphics.programs.get(lineVertex,lineFragment).ready}groundProgram(...defines){let{groundVertex,
groundFragment}=this.header.shaders;return this.graphics.programs.get(groundVertex,groundFragment,...defines)}get hasCells(){
return GROUND.some(name=>this.parts.has(name))}get roundness(){return this.header.earth?.map===null?["FLOWTEX_ROUND"]:[]}drawGround({
camera,anchor}){let{header,graphics}=this,{earth,geometry}=header;if(!earth?.land)return;let globe=earth.map===null,cells=GROUND.
filter(name=>this.parts.has(name)),gl=graphics.context,common={u_matrix:projection(geometry,camera,anchor),u_ground:header.
background??[1,1,1],u_lit:header.lighting,u_toEye:toFrame(geometry.frame,scale2(camera.axes[2],-1))},missing=missingColour(
header);if(globe&&earth.below){let program2=this.groundProgram("FLOWTEX_GLOBE");if(!program2.ready)return;graphics.programs.
use(program2,{...common,u_colour:missing,...this.disc(camera,earth.radius,anchor)}),gl.bindVertexArray(this.take("disc",
anchor,()=>this.emptyArray()).array),gl.drawArrays(gl.TRIANGLE_STRIP,0,4)}let program=this.groundProgram(...this.roundness);
if(!cells.length||!program.ready)return gl.bindVertexArray(null);gl.depthMask(!1);for(let name of cells){let colour=name===
"land"?earth.land:missing,middle=subtract2(toFrame(geometry.frame,scale2(geometry.center,-1)),anchor);graphics.programs.
use(program,{...common,u_colour:colour,...globe&&{u_middle:middle}});let drawn=this.take(name,anchor,()=>this.cellsOf(name,
anchor));gl.bindVertexArray(drawn.array),gl.drawElements(gl.TRIANGLES,drawn.count,gl.UNSIGNED_INT,0)}gl.depthMask(!0),gl.
bindVertexArray(null)}horizon(camera){let{earth}=this.header;if(!earth||earth.map)return null;let{radius}=earth,[x,y,z,w]=camera.
eye,away=w*Math.hypot(x,y,z);return[...unit([x,y,z]),away?-(radius**2)/away:0]}localPlane(plane,anchor){let{frame,center}=this.
header.geometry,normal=plane.slice(0,3),local=toFrame(frame,normal);return[...local,dot2(local,anchor)+dot2(normal,center)+
plane[3]]}disc(camera,radius,anchor){let{frame,center}=this.header.geometry,[a,b,c,offset]=this.horizon(camera)??[0,0,1,
0],toEye=[a,b,c],size=Math.sqrt(Math.max(radius**2-offset**2,0)),aside=unit(cross2(camera.axes[1],toEye)),upward=cross2(
toEye,aside),middle=add(scale2(toEye,-offset),center,-1);return{u_middle:subtract2(toFrame(frame,middle),anchor),u_aside:scale2(
toFrame(frame,aside),size),u_upward:scale2(toFrame(frame,upward),size),u_away:camera.state.parallel?0:length2(camera.state.
position)/radius}}take(name,anchor,make,spacing=0){let old=this.drawn.get(name);if(old&&String([old.anchor,old.spacing])===
String([anchor,spacing]))return old;this.drop(name);let drawn={...make(),anchor,spacing};return this.drawn.set(name,drawn),
drawn}emptyArray(){let{graphics}=this;return{array:graphics.counted(graphics.context.createVertexArray()),buffers:[],anchor:[
0,0,0],spacing:0,count:0,groups:[]}}buffer(target,data){let{graphics}=this,gl=graphics.context,buffer=graphics.counted(gl.
createBuffer());return gl.bindBuffer(target,buffer),gl.bufferData(target,data,gl.STATIC_DRAW),buffer}linesOf(name,anchor,spacing){
let gl=this.graphics.context,{earth}=this.header,steps=this.parts.get(name)?.data??[],lines=earth?linesOf(steps,earth):[],
points=linePoints(thinned(lines,spacing),anchor),drawn={...this.emptyArray(),groups:pieceGroups(points)};gl.bindVertexArray(
drawn.array),drawn.buffers=[this.buffer(gl.ARRAY_BUFFER,points)];for(let n=0;n<PIECE_ENDS;n+=1)gl.enableVertexAttribArray(
n),gl.vertexAttribDivisor(n,1);return drawn}cellsOf(name,anchor){let gl=this.graphics.context,cells=this.parts.get(name),
nodes=this.parts.get("position"),drawn=this.emptyArray();if(!cells||!nodes)return drawn;let corners=this.header.geometry.
triangles?cells.data:cellCorners(cells);gl.bindVertexArray(drawn.array);let points=positions(nodes.data,anchor);return drawn.
buffers=[this.buffer(gl.ARRAY_BUFFER,points),this.buffer(gl.ELEMENT_ARRAY_BUFFER,corners)],drawn.count=corners.length,gl.
enableVertexAttribArray(0),gl.vertexAttribPointer(0,3,gl.FLOAT,!1,0,0),drawn}};function cellCorners({data,shape:[rows,columns]}){
let corners=[];for(let n=0;n<rows*columns;n+=1){if(!data[n])continue;let low=n+Math.floor(n/columns),high=low+columns+1;
corners.push(low,low+1,high+1,low,high+1,high)}return Uint32Array.from(corners)}var[NEARER,ABOVE_SHARE]=[.01,.2],[ROW,ENDS_BYTES2]=[4,24],REACH_PX=9;function shapesOf(points,lines,most){let shapes={lines:{
"from saddle":[],"to saddle":[],"stable orbit":[],"unstable orbit":[]},points:[]};for(let n=0;n<Math.min(points.length/ROW,
most.points);n+=1){let kind=points[ROW*n+3];(shapes.points[kind]??=[]).push(...[0,1,2].map(k=>points[ROW*n+k]))}let last=NaN;
for(let n=0;n<lines.length/ROW;n+=1){let number=lines[ROW*n+3];if(number>=LINE.saddle*most.saddles)continue;let names=number&
LINE.orbit?["stable orbit","unstable orbit"]:["from saddle","to saddle"],path=shapes.lines[names[number&LINE.leaving?0:1]];
number!==last&&path.push([]),last=number,path[path.length-1].push(...[0,1,2].map(k=>lines[ROW*n+k]))}return shapes}function zeroPieces(rows,component){
let numbers=[];for(let n=0;n<rows.length;n+=ROW)rows[n+3]===component&&numbers.push(rows[n],rows[n+1],rows[n+2]);return Float32Array.
from(numbers)}function ends(paths,areDots=!1){let values=Float32Array.from(paths.flat());if(areDots)return atEnds(values,
Array.from({length:2*values.length/3},(_,n)=>n>>1),3);let pieces=[],first=0;for(let path of paths){let count2=path.length/
3;for(let n=first;n<first+count2-1;n+=1)pieces.push(n,n+1);first+=count2}return atEnds(values,pieces,3)}var Marks=class{graphics;header;parts;array=null;buffer=null;drawn=null;constructor(graphics,header,parts){
this.graphics=graphics,this.header=header,this.parts=parts}kinds(settings){let there=this.header.structure?.parts??[];return Object.
keys(MARKS).filter(kind=>there.includes(kind)&&Number(settings[MARKS[kind]])>0)}lacking(settings,moment){let step=nearest(
moment);return this.kinds(settings).flatMap(kind=>this.parts.has(`${kind}/${step}`)?[]:[[kind,step]])}get program(){let{
lineVertex,lineFragment}=this.header.shaders;return this.graphics.programs.get(lineVertex,lineFragment,"FLOWTEX_BODY","F\
LOWTEX_MARK")}isReady(settings){return!this.kinds(settings).length||this.program.ready}shown(settings,moment,kind){let part=this.
kinds(settings).includes(kind)?this.parts.get(`${kind}/${nearest(moment)}`):void 0;return[part?Number(settings[MARKS[kind]]):
0,part]}legend(settings,moment){let[most,part]=this.shown(settings,moment,"critical"),kinds=new Set;for(let n=0;n<Math.min(
most,part?.shape[0]??0);n+=1)kinds.add(Number(part?.data[ROW*n+3]));let{kinds:all=[],lines={},nullclines:nullclines2=[]}=this.
header.structure??{},[saddles,paths]=this.shown(settings,moment,"separatrices"),drawn=Object.entries(shapesOf([],paths?.
data??[],{points:0,saddles}).lines).filter(([,some])=>some.length).map(([name])=>({name,color:lines[name]}));return this.
shown(settings,moment,"nullclines")[0]&&drawn.push(...nullclines2),[...all.filter((_,n)=>kinds.has(n)),...drawn.map(line=>({
...line,isLine:!0}))]}draw({camera,anchor,width,height,ratio},settings,moment){let{header,graphics}=this,{structure,geometry}=header,
layers=structure&&this.layers(structure,settings,moment);if(!structure||!layers?.length)return;let gl=graphics.context,[
x,y,z,w]=camera.eye,eye=toFrame(geometry.frame,subtract2([x,y,z],scale2(geometry.center,w))),wider=ratio*clamp(Math.sqrt(
height/ratio/structure.usualHeight),...structure.widthRange),distance2=w?1:camera.distance/Math.hypot(...eye);gl.bindVertexArray(
this.array),gl.enable(gl.BLEND),gl.blendFuncSeparate(gl.SRC_ALPHA,gl.ONE_MINUS_SRC_ALPHA,gl.ZERO,gl.ONE),gl.depthFunc(gl.
LEQUAL);let program=this.program;graphics.programs.use(program,{u_matrix:projection(geometry,camera,anchor),u_anchor:anchor,
u_eye:[...subtract2(eye,scale2(anchor,w)),w],u_picture:[width,height],u_horizon:[0,0,0,1]}),gl.bindBuffer(gl.ARRAY_BUFFER,
this.buffer);for(let{first,count:count2,color,width:thickness,above}of layers){let[r,g,b,opacity=1]=color;graphics.programs.
use(program,{u_width:thickness*wider,u_nearer:NEARER*distance2*(1+ABOVE_SHARE*above)});for(let end of[0,1])gl.vertexAttribPointer(
end,3,gl.FLOAT,!1,ENDS_BYTES2,ENDS_BYTES2*(first+end/2)),gl.vertexAttrib4f(2+end,r,g,b,opacity);gl.drawArraysInstanced(gl.
TRIANGLE_STRIP,0,4,count2)}gl.bindVertexArray(null),gl.depthFunc(gl.LESS),gl.disable(gl.BLEND)}layers(structure,settings,moment){
let[[points,dots],[saddles,lines],[,zeros2]]=["critical","separatrices","nullclines"].map(kind=>this.shown(settings,moment,
kind)),key=JSON.stringify([points,dots?.digest,saddles,lines?.digest,zeros2?.digest,nearest(moment)]);if(this.drawn?.key===
key)return this.drawn.layers;let shapes=shapesOf(dots?.data??[],lines?.data??[],{points,saddles}),{line,dot:dot3,rim,middle}=structure,
layers=[],pieces=[],first=0,put=(data,color,width,above)=>{let count2=data.length/6;count2&&layers.push({first,count:count2,
color,width,above}),pieces.push(data),first+=count2},nullclines2=structure.nullclines.map((_,n)=>zeroPieces(zeros2?.data??
[],n));nullclines2.forEach(data=>put(data,rim,line[0],0)),nullclines2.forEach((data,n)=>put(data,structure.nullclines[n].
color,line[1],1)),put(ends(Object.values(shapes.lines).flat()),rim,line[0],1.5),Object.entries(shapes.lines).forEach(([name,
paths],n)=>put(ends(paths),structure.lines[name],line[1],2+n));let places=structure.kinds.map((_,n)=>shapes.points[n]??[]);
return put(ends(places,!0),rim,dot3[0],6),structure.kinds.forEach(({color},n)=>put(ends([places[n]],!0),color,dot3[1],7)),
put(ends(places.filter((_,n)=>structure.kinds[n].turns),!0),middle,dot3[2],8),this.send(pieces),this.drawn={key,layers},
layers}send(pieces){let{graphics}=this,gl=graphics.context;this.array??=graphics.counted(gl.createVertexArray()),this.buffer??=
graphics.counted(gl.createBuffer()),gl.bindVertexArray(this.array),gl.bindBuffer(gl.ARRAY_BUFFER,this.buffer),gl.bufferData(
gl.ARRAY_BUFFER,Float32Array.from(pieces.flatMap(some=>[...some])),gl.STATIC_DRAW);for(let end of[0,1])gl.enableVertexAttribArray(
end),gl.vertexAttribDivisor(end,1);gl.bindVertexArray(null)}at({place,position,height},camera,settings,moment){let{geometry,
structure}=this.header,[most,part]=this.shown(settings,moment,"critical"),pixel=2*camera.height/Math.max(height,1),[kind,
least]=["",REACH_PX];for(let n=0;n<Math.min(most,part?.shape[0]??0);n+=1){let[a,b,c,number]=[0,1,2,3].map(k=>Number(part?.
data[ROW*n+k])),point=add(fromFrame(geometry.frame,[a,b,c]),geometry.center),seen=camera.project(point);if(!seen||Math.hypot(
...subtract2(point,position))>4*REACH_PX*pixel)continue;let away=.5*height*Math.hypot((seen[0]-place[0])*camera.aspect,seen[1]-
place[1]);away<least&&([kind,least]=[structure?.kinds[number]?.name??"",away])}return kind}dispose(){this.graphics.free(
"Buffer",this.buffer),this.graphics.free("VertexArray",this.array),this.array=this.buffer=this.drawn=null}};function nearest([
before,after,between3]){return between3<.5?before:after}var USERS={position:["nodes"],normal:["nodes"],cells:["cells"],triangles:["nodes","cells","scalar"],blocks:["cells"],cmap:[
"cmap"],image:["image"],step:["step"],scalars:["scalar"]},SOURCES=["padded","unit","open","nearest","rays"],TEXEL_BYTES=8*
(4/3),CORNERS_WIDTH=2048,ARRAYS=["u_slices","u_slicesNext","u_image","u_stepImage","u_nodes"],count=0,Scene=class{graphics;header;parts;earth;bodies;arrows;marks;tile;anchor=[
0,0,0];version=0;resources=new Map;scalarSteps="";most=null;tracing="";wanted=[];number=count+=1;constructor(graphics,header,parts,tile=null){
this.tile=tile,this.graphics=graphics,this.header=header,this.parts=parts,this.earth=new EarthLayer(graphics,header,parts),
this.bodies=new Bodies(graphics,header,parts),this.arrows=new Arrows(graphics,header,parts),this.marks=new Marks(graphics,
header,parts)}isReady(settings,smooth=!1){let programs=[!1,!0].map(isClose=>this.arrows.program(settings,isClose));return[
...["place","blur","colour","surface","smooth","probe"].filter(name=>smooth||name!=="smooth").map(name=>this.programs(name).
ready),this.earth.isReady,this.bodies.isReady,this.marks.isReady(settings)].every(Boolean)&&programs.every(program=>program?.
ready??!0)}missing(before,after){let{geometry,slices,scalars,image,pyramid,formula}=this.header,{trace}=slices,names=["m\
esh",...trace?.parts??["position",...geometry.planar?[]:["normal"]]];pyramid&&!formula&&names.push("places"),this.header.
bodies?.runs.length&&names.push(...BODY_PARTS),geometry.triangles&&names.push("triangles","blocks");for(let step of new Set(
[before,after]))trace?names.push(...flowsOf(this.header,step).map(n=>`flow/${n}`)):names.push(`slices/${step}`),slices.channels===
2&&names.push(`extra/${step}`);return names.push(...this.scalarParts(before,after)),scalars.name!==null&&names.push("cma\
p"),image&&names.push("image","step"),[...new Set(names)].filter(name=>!this.fits(name))}lacking(step){let steps=this.missing(
step,step).map(name=>name.startsWith("flow/")?stepOf(name):step);return[...new Set(steps)]}scalarParts(before,after,of=this.
header.scalars){let{name,steps,number}=of;if(name===null)return[];let end=number?`/${number}`:"";return(steps>1?[before,
after]:[0,0]).map(step=>`scalars/${step}${end}`)}fits(name){let part=this.parts.get(name);if(!part)return!1;let{geometry,
slices,image,mesh}=this.header,blocks=geometry.shape.map(n=>Math.max(Math.ceil((n-1)/mesh.tileCells),1)),nodes=slices.trace?.
nodes??[],shape2={flow:[...nodes,part.shape[2]],unit:nodes,padded:[...nodes.map(n=>n+2),3],slices:[slices.count,geometry.
rows.size,geometry.columns.size,slices.channels],position:[...geometry.shape,3],mesh:geometry.triangles?part.shape:[...blocks,
part.shape[2]],step:image?[...image.stepSize].reverse():[]}[name.split("/")[0]];return!shape2||String(shape2)===String(part.
shape)}make(steps,until){let{slices,geometry}=this.header,{trace}=slices;if(!trace)return!0;let padded=this.part("padded"),
digest=name=>this.key(["padded"],name,trace);return this.put("position",digest("position"),()=>positionOf(padded,trace,geometry.
shape)),!geometry.planar&&!trace.parts.includes("normal")&&this.put("normal",digest("normal"),()=>normalOf2(padded,trace,
geometry.shape)),this.wanted=steps,steps.every(step=>this.trace(step,until))}prepare(){let{trace}=this.header.slices;trace&&
programsOf(this.graphics,this.header,trace)}trace(step,until){let{graphics,header}=this,{trace,lags,sides}=header.slices,
name=`slices/${step}`;if(!trace||this.resources.has(name))return!0;let flows=flowsOf(header,step).map(n=>`flow/${n}`),key=this.
key([...flows,...SOURCES],step,trace,lags,sides,header.geometry.levels),texture=null;if(!key||!graphics.common.has(`slic\
es ${key}`)){let{tracings}=graphics,tracked=key||`${this.number} ${step}`;this.tracing!==tracked&&this.stopTracing();let find=part=>this.
parts.get(part),tracing=tracings.get(tracked)??new Tracing(graphics,header,trace,find,step);if(tracings.set(this.tracing=
tracked,tracing),texture=tracing.advance(until),!texture)return!1;this.stopTracing()}return this.take(name,"Texture",key,
()=>texture,()=>{}),!0}put(name,digest,make){let{graphics,parts}=this;if(parts.get(name)?.digest===digest)return;let part=graphics.
stock.get(digest)?.part??{...make(),digest};graphics.release(parts.get(name)),parts.set(name,graphics.hold(part)),this.forget(
name)}isMade(steps){return!this.missing(steps[0],steps[steps.length-1]).length&&(!this.header.slices.trace||this.isLoaded(
steps))}stopTracing(){this.graphics.tracings.get(this.tracing)?.dispose(),this.graphics.tracings.delete(this.tracing),this.
tracing=""}part(name){let part=this.parts.get(name);if(!part)throw new Error(`the part "${name}" of the scene is missing`);
return part}forget(name){let[kind,step]=name.split("/");["position","cells","triangles"].includes(kind)&&this.arrows.forget();
let sliced=["slices","extra","flow"].includes(kind);!sliced&&kind!=="scalars"&&(this.earth.forget(name),this.version+=1,
this.most=null),BODY_PARTS.includes(kind)&&this.bodies.dispose();for(let user of sliced?[`slices/${step}`]:USERS[kind]??
[])this.drop(user);SOURCES.includes(kind)&&(this.wanted=[],this.dropSlices(NaN,NaN))}drop(name){let resource=this.resources.
get(name);this.resources.delete(name),resource&&(resource.users-=1,!resource.users&&(this.graphics.free(resource.kind,resource.
object),this.graphics.common.delete(resource.key)))}dispose(){for(let name of[...this.resources.keys()])this.drop(name);
this.stopTracing(),this.earth.dispose(),this.bodies.dispose(),this.arrows.dispose(),this.marks.dispose()}key(names,...rest){
let digests=names.map(name=>this.parts.has(name)?this.part(name).digest:"none");return digests.every(Boolean)?JSON.stringify(
[digests,rest]):""}take(name,kind,key,make,fill){let own=this.resources.get(name);if(own)return own.object;let{graphics}=this,
whole=key&&`${name.split("/")[0]} ${key}`,shared2=whole?graphics.common.get(whole):void 0,object=shared2?.object??graphics.
counted(make()),resource=shared2??{kind,object,count:0,key:whole,users:0};return resource.users+=1,this.resources.set(name,
resource),shared2||(resource.count=fill(object)||0),whole&&graphics.common.set(whole,resource),object}get blocks(){return this.
part("mesh")}get doublings(){let{geometry,mesh}=this.header;return this.most??=mostDoublings(geometry,this.blocks,this.part(
"position").data,mesh.tileCells)}cornersAt(place){let{triangles,shape:shape2}=this.header.geometry;return triangles?cornersOf(
this.part("triangles").data,place):cornersAt(shape2,place)}isLoaded(steps){return steps.every(step=>this.resources.has(`\
slices/${step}`))}get tracedBytes(){let{slices,geometry}=this.header;return slices.trace?[...this.resources.keys()].filter(
name=>name.startsWith("slices/")).length*TEXEL_BYTES*slices.count*geometry.rows.size*geometry.columns.size:0}load(steps){
for(let step of steps)this.slices(step)}bindNodes(anchor){let gl=this.graphics.context,{shape:shape2,triangles,planar}=this.
header.geometry;anchor.some((x,k)=>x!==this.anchor[k])&&this.drop("nodes"),this.anchor=anchor;let[height,width]=this.nodesSize,
nodes=this.texture("nodes",this.key(["position","normal"],width,anchor),texture=>{checkSize(gl,width,height),gl.bindTexture(
gl.TEXTURE_2D_ARRAY,texture);let data=new Float32Array((planar?3:6)*width*height);data.set(positions(this.part("position").
data,anchor)),planar||data.set(unitNormals(this.part("normal").data),3*width*height);let size=[width,height,planar?1:2];
gl.texImage3D(gl.TEXTURE_2D_ARRAY,0,gl.RGB32F,...size,0,gl.RGB,gl.FLOAT,data),nearest2(gl,gl.TEXTURE_2D_ARRAY)}),open=()=>this.
parts.get("cells")?.data??Uint8Array.of(1),cells=triangles?this.table("cells",this.key(["triangles","blocks"]),gl.RGBA32UI,
CORNERS_WIDTH,()=>cornersAndBlocks(this.part("triangles").data,this.part("blocks").data)):this.table("cells",this.key(["\
cells"],shape2),gl.R8UI,this.parts.has("cells")?shape2[1]-1:1,open);this.bind("u_nodes",nodes),this.bind(triangles?"u_co\
rners":"u_open",cells)}get nodesSize(){let{shape:shape2,triangles,rows,columns}=this.header.geometry;return triangles?[rows.
size,columns.size]:shape2}bind(sampler,texture){let gl=this.graphics.context;gl.activeTexture(gl.TEXTURE0+SAMPLERS.indexOf(
sampler)),gl.bindTexture(ARRAYS.includes(sampler)?gl.TEXTURE_2D_ARRAY:gl.TEXTURE_2D,texture),gl.activeTexture(gl.TEXTURE0+
SAMPLERS.length)}table(name,key,inner,width,values){let gl=this.graphics.context,formats={[gl.RGBA32UI]:[gl.RGBA_INTEGER,
gl.UNSIGNED_INT,4],[gl.R8UI]:[gl.RED_INTEGER,gl.UNSIGNED_BYTE,1],[gl.RG32F]:[gl.RG,gl.FLOAT,2],[gl.RGBA32F]:[gl.RGBA,gl.
FLOAT,4]},[format,type,channels]=formats[inner];return this.texture(name,key,texture=>{let data=values(),height=Math.ceil(
data.length/channels/width);gl.bindTexture(gl.TEXTURE_2D,texture),gl.pixelStorei(gl.UNPACK_ALIGNMENT,1);let all=filled(data,
channels*width*height);gl.texImage2D(gl.TEXTURE_2D,0,inner,width,height,0,format,type,all),nearest2(gl,gl.TEXTURE_2D)})}shares(before,after){
let{geometry,scalars}=this.header,{shape:shape2}=geometry,painted=this.scalarParts(before,after);return[this.key(["trian\
gles",...new Set(painted)],shape2,scalars.low,scalars.high,scalars.log),()=>shares(painted.map(name=>this.part(name).data),
scalars)]}texture(name,key,fill){let gl=this.graphics.context;return this.take(name,"Texture",key,()=>gl.createTexture(),
fill)}slices(step){let{slices,geometry}=this.header,key=this.key([`slices/${step}`,`extra/${step}`],geometry.levels,slices.
extra);return this.texture(`slices/${step}`,key,texture=>{let part=this.part(`slices/${step}`),[layers,height,width,channels]=part.
shape,data=part.data,extra=this.parts.get(`extra/${step}`)?.data,texels=height*width,layer=n=>{let own=data.subarray(n*texels*
channels,(n+1)*texels*channels);if(channels===4)return own;let all=new Uint16Array(4*texels),place=slices.extra.indexOf(
n),fourth=place<0?null:extra?.subarray(place*texels,(place+1)*texels);for(let k=0;k<texels;k+=1)all[4*k]=own[2*k],all[4*
k+1]=own[2*k+1],fourth&&(all[4*k+3]=fourth[k]);return all};this.fill(texture,{width,height,layers,channels:4,levels:geometry.
levels},layer)})}programs(name){let{programs}=this.graphics,{vertex,place,fullVertex,even,surface,...others}=this.header.
shaders;return name==="place"?programs.get(vertex,place):name==="smooth"?programs.get(vertex,surface,"FLOWTEX_SMOOTH"):name===
"surface"?programs.get(fullVertex,surface):name==="blur"?programs.get(fullVertex,even):programs.get(fullVertex,others[name])}texels(step,texels){
let{graphics,header}=this,gl=graphics.context,{slices,geometry}=header,width=geometry.columns.size,texture=this.slices(step),
draw=()=>{gl.activeTexture(gl.TEXTURE0),gl.bindTexture(gl.TEXTURE_2D_ARRAY,texture),gl.bindVertexArray(null);let places=texels.
flatMap(n=>[n%width,Math.floor(n/width)]);graphics.programs.use(this.programs("probe"),{u_texels:places}),gl.drawArrays(
gl.TRIANGLES,0,3)},bits=graphics.numbers(draw,texels.length,slices.count),numbers=new Float32Array(bits.buffer);return(layer,n)=>{
let[x,y,z,w]=numbers.subarray(4*(layer*texels.length+n));return[x,y,z,w]}}image(name,repeat){let gl=this.graphics.context;
return this.texture(name,this.key([name],repeat),texture=>{let{data,shape:shape2}=this.part(name),[height,width,channels=1]=shape2,
levels=Math.floor(Math.log2(Math.max(width,height))),size={width,height,layers:1,channels,levels};this.fill(texture,size,
()=>data);let wrap=n=>repeat[n]?gl.REPEAT:gl.CLAMP_TO_EDGE;gl.texParameteri(gl.TEXTURE_2D_ARRAY,gl.TEXTURE_WRAP_S,wrap(1)),
gl.texParameteri(gl.TEXTURE_2D_ARRAY,gl.TEXTURE_WRAP_T,wrap(0))})}fill(texture,size,layer){let gl=this.graphics.context,
{width,height,layers,channels,levels}=size;makeLayers(gl,texture,size),gl.pixelStorei(gl.UNPACK_ALIGNMENT,1);let format=channels===
1?gl.RED:gl.RGBA;for(let n=0;n<layers;n+=1)gl.texSubImage3D(gl.TEXTURE_2D_ARRAY,0,0,0,n,width,height,1,format,gl.HALF_FLOAT,
layer(n));levels&&gl.generateMipmap(gl.TEXTURE_2D_ARRAY)}dropSlices(before,after){let next=after+1<this.header.slices.steps?
after+1:0,kept=[before,after,next,after+1,...this.wanted];for(let name of[...this.resources.keys()])name.startsWith("sli\
ces/")&&!kept.includes(stepOf(name))&&this.drop(name)}bindTextures(before,after){let gl=this.graphics.context,{image,scalars}=this.
header,steps=String(this.scalarParts(before,after));steps!==this.scalarSteps&&this.drop("scalar"),this.scalarSteps=steps,
this.dropSlices(before,after),this.bind("u_slices",this.slices(before)),this.bind("u_slicesNext",after===before?null:this.
slices(after)),this.bind("u_image",image&&this.image("image",image.repeated)),this.bind("u_stepImage",image&&this.image(
"step",image.repeat));let colours=texelsOf(this.parts.get("cmap")?.data??new Uint8Array(4),scalars);this.bind("u_cmap",this.
table("cmap",this.key(["cmap"],scalars.beyond),gl.RGBA32F,colours.length/4,()=>colours));let[key,values]=this.shares(before,
after);this.bind("u_shares",scalars.name===null?null:this.table("scalar",key,gl.RG32F,this.nodesSize[1],values));let along2=()=>alongAxes(
image?.alongI??[],image?.alongJ??[]);this.bind("u_along",image&&this.table("along","",gl.RG32F,Math.max(image.alongI.length,
image.alongJ.length),along2))}};function nearest2(gl,target){gl.texParameteri(target,gl.TEXTURE_MIN_FILTER,gl.NEAREST),gl.
texParameteri(target,gl.TEXTURE_MAG_FILTER,gl.NEAREST)}function filled(data,length3){if(data.length===length3)return data;
let all=new data.constructor(length3);return all.set(data),all}var REQUEST_MS=60,LOAD_MS=25,BUDGET_BYTES=9e8,BYTES_HELD=3.5,STEPS_HELD2={slices:4,flow:24},Tiles=class{layers=[];missing=[];wanted=0;pending=0;host;root;tiles=new Map;pyramid=null;chosen={
choices:new Map,steps:[],names:""};count=0;isWaiting=!1;hasAsked=!1;isOver=!1;failed=new Failures;constructor(host,root){
this.host=host,this.root=root}has(name,part){return this.tiles.get(name)?.parts.has(part)??!1}fail(name,steps){this.failed.
add(this.need(name,steps)),this.host.refine()}need(name,steps){return`${name} ${steps} ${this.root.header.scalars.name}`}dispose(){
this.isOver=!0;for(let name of[...this.tiles.keys()])this.drop(name)}setPart(name,part){let{graphics,header}=this.root,tile=this.
tiles.get(name)??this.emptyTile();if(this.tiles.set(name,tile),part.digest&&tile.parts.get(part.name)?.digest===part.digest)
return;if(graphics.release(tile.parts.get(part.name)),tile.parts.set(part.name,graphics.hold(part)),part.name==="header"){
let own=JSON.parse(new TextDecoder().decode(part.data));tile.scene?.dispose(),own&&(own.geometry.reach=header.geometry.reach),
tile.scene=own&&new Scene(graphics,{...header,...own,pyramid:null,bodies:null,structure:null},tile.parts,keyOf(name)),this.
giveMap(tile)}else tile.scene?.forget(part.name);let{names,steps}=this.chosen;this.missing=this.missing.filter(missing=>!this.
isHere(missing,steps));let shown=cover(this.chosen.choices,other=>this.isHere(other,steps));String([...shown.keys()])!==
names&&this.host.refine()}recolour(colours={}){let{steps}=this.chosen;for(let tile of this.tiles.values()){let{scene,parts}=tile;
if(!scene||(Object.assign(scene.header,colours),this.giveMap(tile),scene.forget("scalars"),(steps.length?scene.scalarParts(
steps[0],steps[steps.length-1]):[]).every(name=>parts.has(name))))continue;let others=[...parts.keys()].filter(name=>name.
startsWith("scalars/"));for(let name of others)this.release(tile,name)}}emptyTile(){return{parts:new Map,scene:void 0,used:this.
count}}giveMap({scene,parts}){let map=this.root.parts.get("cmap");map&&parts.set("cmap",map),scene?.forget("cmap")}arrange([
before,after]){let{camera}=this.host;if(!camera)return[];let shown=this.choose(camera,[...new Set([before,after])]);return this.
layers=[ROOT,...[...shown.keys()].filter(name=>name!==ROOT)].flatMap(name=>{let scene=name===ROOT?this.root:this.tiles.get(
name)?.scene,covered=(shown.get(name)??[]).flatMap(finer=>this.pyramid?[this.pyramid.finerPart(keyOf(finer),name)]:[]),key=name===
ROOT?[this.root.header.pyramid?.depth??0,0,0]:keyOf(name);return scene?[{scene,key,covered}]:[]}),this.layers}choose(camera,steps){
let{header}=this.root,{settings,canvas,ratio}=this.host;if(!header.pyramid)return new Map;this.pyramid??=new Pyramid(header.
pyramid,placesOf(header)??this.root.part("places").data);let choices=this.pyramid.choose({...camera.sight(canvas.height/
ratio),planes:camera.planes,cellPixels:cellPixels(header.pyramid,settings),shownOn:this.host.shownOn});this.count+=1;for(let name of choices.
keys()){let tile=this.tiles.get(name);tile&&(tile.used=this.count)}let until=performance.now()+LOAD_MS,wanted=this.obtainable(
wantedTiles(choices),steps,header.pyramid.depth);this.missing=wanted.filter(name=>!this.isHere(name,steps)),this.ask(),this.
trim(steps);for(let name of wanted)this.isHere(name,steps)&&this.load(name,steps,until);let shown=cover(choices,name=>this.
isHere(name,steps)&&this.load(name,steps,until));return this.wanted=wanted.length,this.pending=wanted.filter(name=>!this.
isHere(name,steps)||!this.isLoaded(name,steps)).length,this.chosen={choices,steps,names:String([...shown.keys()])},shown}obtainable(names,steps,depth){
let needs=[steps,...steps.map(step=>[step])],isFailed=name=>needs.some(some=>this.failed.has(this.need(name,some))),found=names.
map(name=>{let[level,row2,column]=keyOf(name);for(;level<depth&&isFailed(nameOf([level,row2,column]));)[level,row2,column]=
[level+1,row2>>1,column>>1];return level<depth?nameOf([level,row2,column]):ROOT});return[...new Set(found)].filter(name=>name!==
ROOT)}isHere(name,steps){let scene=this.tiles.get(name)?.scene;return scene===null||scene?.missing(steps[0],steps[steps.
length-1]).length===0}isLoaded(name,steps){let scene=this.tiles.get(name)?.scene;return scene===null||(scene?.isLoaded(steps)??
!1)}load(name,steps,until){let scene=this.tiles.get(name)?.scene;return!scene||this.isLoaded(name,steps)?!0:performance.
now()>until||!scene.make(steps,until)?(this.host.refine(),!1):(scene.load(steps),!0)}ask(){let{requests,lifetime}=this.host;
this.isWaiting||!(this.missing.length||this.hasAsked)||(this.isWaiting=!0,lifetime.later(()=>{if(this.isWaiting=!1,this.
isOver)return;this.hasAsked=this.missing.length>0;let lacking=(name,step)=>this.tiles.get(name)?.scene?.lacking(step)??flowsOf(
this.root.header,step),needed=this.missing.flatMap(name=>this.chosen.steps.flatMap(step=>lacking(name,step))),steps=[...new Set(
needed)].sort((a,b)=>a-b);requests.wantTiles(this.missing.map(keyOf),steps)},REQUEST_MS))}trim(steps){let bytes=0;for(let[
name,tile]of[...this.tiles].sort(([,a],[,b])=>b.used-a.used)){let{parts,scene,used}=tile,kind=scene?.header.slices.trace?
"flow":"slices",held=[...parts.keys()].filter(part=>part.startsWith(`${kind}/`)),needed=scene?steps.flatMap(step=>flowsOf(
scene.header,step)):steps;for(let part of held.slice(0,Math.max(held.length-STEPS_HELD2[kind],0))){let step=stepOf(part);
if(needed.includes(step))continue;for(let each of[kind,"extra"])this.release(tile,`${each}/${step}`);let values=[...parts.
keys()].filter(each=>isOfStep(each,step,this.root.header));for(let each of values)this.release(tile,each)}for(let{data}of parts.
values())bytes+=BYTES_HELD*data.byteLength;bytes+=scene?.tracedBytes??0,bytes>(this.host.options.source?.memory??BUDGET_BYTES)&&
used<this.count&&this.drop(name)}}drop(name){let tile=this.tiles.get(name);tile?.scene?.dispose();for(let part of[...tile?.
parts.keys()??[]])this.release(tile,part);this.tiles.delete(name)}release(tile,part){part!=="cmap"&&this.root.graphics.release(
tile?.parts.get(part)),tile?.parts.delete(part)}};var WebGL2Painter=class{scene=null;tiles=null;places=null;shown=null;view;renderer;next=[];isLate=!1;constructor(view){this.
view=view,this.renderer=new ProgressiveRenderer(view,this),!view.graphics.gl&&view.panel.fail("This browser has no WebGL\
2 with floating-point targets, which are needed to draw the picture.","Turn on hardware acceleration in its settings, or\
 use a recent Firefox, Chrome or Safari.")}open(header){let{view}=this;this.leave(),this.scene=new Scene(view.graphics,header,
view.parts),this.tiles=new Tiles(view,this.scene),this.places=new Places(view.graphics)}leave(){this.tiles?.dispose(),this.
scene?.dispose(),this.places?.dispose(),this.tiles=this.scene=this.places=null}dispose(){this.leave(),this.renderer.dispose()}restart(cameraOnly){
this.renderer.restart(cameraOnly)}resize(width,height){this.renderer.resize(width,height)}refine(){this.renderer.refine()}arrange(shown){
let layers=this.tiles?.arrange(shown)??[];return this.view.root.dataset.tiles=String(this.tiles?.pending??0),layers}get smooth(){
let{header,options}=this.view;return options.smooth!==void 0||!header?options.smooth??!1:this.program(header).price<CARD_PRICE_MS}get isComing(){
return!!this.tiles?.missing.length}get lacking(){let[before,after]=this.view.player.moment;return this.scene?.missing(before,
after)??[]}missing(steps){return[...new Set(steps.flatMap(step=>this.scene?.lacking(step)??[]))]}make(steps,until){return this.
next=steps,!this.missing(steps).length&&!!this.scene?.make(steps,until)}available(until){let{view,scene,shown,lacking}=this,
{header,player}=view;if(!header||!scene)return null;let moment=player.moment,ahead=player.playing?[1,2].map(n=>(moment[1]+
n)%header.slices.steps):[],steps=this.missing([moment[0],moment[1],...this.next,...ahead]);steps.length&&view.requests.hasSteps&&
!view.options.isComing?.()&&view.requests.wantSteps(steps);let isMade=!lacking.length&&scene.make(moment.slice(0,2),until);
this.isLate=!isMade;let marks=view.requests.hasMarks?scene.marks.lacking(view.settings,moment):[];return view.options.isComing?.()||
view.requests.wantMarks(marks),view.root.dataset.lacking=String(lacking.length+marks.length||+!isMade),view.panel.wait(lacking,
isMade,this.renderer.leavesOut,marks.length>0),view.panel.showKinds(scene.marks.legend(view.settings,moment)),isMade&&String(
moment.slice(0,2))!==String(shown?.slice(0,2))&&(view.trim(),view.change()),isMade?this.shown=moment:(lacking.length||view.
request(),shown&&scene.isMade(shown.slice(0,2))?shown:null)}program(header,isClose=this.isClose(header),still=!this.view.
player.playing){let{fullVertex,fragment}=header.shaders,variant=variantOf(header,this.view.settings,isClose,still);return this.
view.graphics.programs.get(fullVertex,fragment,...variant)}isClose(header){let{view}=this;if(!view.camera)return!1;let seen=view.
view([0,0,0],view.ratio),tiles=this.tiles?.layers.slice(1).map(({scene})=>scene.header)??[];return(tiles.length?tiles:[header]).
some(part=>isNear(part,view.settings,seen))}frame(now,until){let{view,scene}=this,{graphics,header}=view;if(graphics.isLost||
!graphics.gl||!view.isVisible||!header||!scene||view.canvas.width<2)return;this.next=[],view.advance(now);let shown=this.
available(until);view.camera||view.place();let program=this.program(header);if(scene.prepare(),!shown||!view.camera||this.
isLate&&view.sharp)return;if(program.error)return view.panel.fail("The shader does not compile with this graphics driver\
.",program.error);if(!program.ready||!scene.isReady(view.settings,this.smooth))return view.request();let isComplete=!view.
sharp&&this.renderer.draw(program,shown,until);isComplete&&(header.slices.critical&&this.program(header,!0),view.player.
varies&&this.program(header,this.isClose(header),!1)),view.painted(isComplete)}get canPick(){return!!this.places?.width&&
!this.view.graphics.isLost}find(x,y){let{tiles,shown,scene,view}=this,{camera}=view,at=tiles?.layers.length&&shown?this.
renderer.placeAt(shown,x,y):null;if(!at||!camera||!shown||!scene)return null;let found=pickedPoint(at,scene,camera,shown,
[x,y]),pointed={place:[x,y],position:found.point.position,height:view.root.clientHeight};return found.point.mark=scene.marks.
at(pointed,camera,view.settings,shown),found}};var SceneView=class{canvas=document.createElement("canvas");root=document.createElement("div");graphics=sharedGraphics();lifetime=new Lifetime;held=new HeldParts(
this.graphics);parts=this.held.all;camera=null;sharp=!1;isVisible=!0;isClear=!1;shownOn=null;dispose(){this.lifetime.isOver||
(this.lifetime.end(),this.requests.stop(),this.painter.dispose?.(),this.held.clear(),this.graphics.leave(this))}get scene(){
return this.painter.scene??null}get tiles(){return this.painter.tiles??null}setPart(part){let tile=tilePart(part.name);return tile&&
this.tiles?.setPart(tile[0],{...part,name:tile[1]}),tile||!this.held.set(part)?!1:(this.scene?.forget(part.name),this.trim(),
part.name==="cmap"&&this.tiles?.recolour(),this.change(),!0)}lack(reason,tile,steps=[]){tile!==void 0&&this.tiles?.fail(
tile,steps),this.tell(reason)}trim(){this.held.trim(this.header,this.options.source,this.player.moment.slice(0,2))}request(){
!this.lifetime.isOver&&this.isVisible&&this.graphics.request(this)}frame(now,until){if(!this.lifetime.isOver)try{this.painter.
frame(now,until)}catch(error){this.fail(error)}}lost(){this.header&&this.painter.open?.(this.header),this.sharp=!1}view(shown,density){
let{header,camera,player,rows}=this;if(!header||!camera)throw new Error("no scene is shown yet");return viewState({header,
camera,anchor:this.scene?.anchor??[0,0,0],player,rows},shown,density)}find(x,y){return this.painter.canPick?this.painter.
find?.(x,y)??null:null}};function dom(kind,attributes={},children=[]){let element=document.createElement(kind);for(let[name,value]of Object.entries(
attributes))element.setAttribute(name,value);return element.append(...children),element}function shape(tag,attributes,children=[]){
let element=document.createElementNS("http://www.w3.org/2000/svg",tag);for(let[name,value]of Object.entries(attributes))
element.setAttribute(name,`${value}`);return element.append(...children),element}var ICONS={play:"M8 5.2v13.6L19 12z",pause:"\
M8.5 6v12M15.5 6v12",previous:"M17 6v12l-9-6zM6.5 6v12",next:"M7 6v12l9-6zM17.5 6v12",home:"M4 11.5 12 5l8 6.5M6.5 10v9h\
11v-9",lod:"M12 3.8l8 4.1-8 4.1-8-4.1zM4 12.2l8 4.1 8-4.1M4 16.3l8 4.1 8-4.1",levels:"M3.5 18a8.5 8.5 0 0 1 17 0M7 18a5 \
5 0 0 1 10 0M10.3 18a1.7 1.7 0 0 1 3.4 0",settings:"M4 7h8M17 7h3M4 17h3M12 17h8M14.5 4.8v4.4M9.5 14.8v4.4",save:"M12 4v\
11M7.5 10.8 12 15.3l4.5-4.5M5 19.5h14",full:"M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",hide:"M6 9.5l6 6 6-6",show:"M6 14.5\
l6-6 6 6"};function icon(name){let path=shape("path",{d:ICONS[name],...name==="play"&&{class:"solid"}});return shape("sv\
g",{viewBox:"0 0 24 24","aria-hidden":"true"},[path])}function numberText(x,digits=4){if(!Number.isFinite(x))return"–";
let size=Math.abs(x);return size!==0&&(size>=1e5||size<.001)?x.toExponential(2).replace("e+","e"):String(Number(x.toPrecision(
digits)))}var UNIT_LENGTH=12;function withUnit(text,unit3){return unit3&&unit3.length<=UNIT_LENGTH?`${text} ${unit3}`:text}
function pictureOf(views,size=1,format={}){let widths=views.map(({canvas})=>Math.max(Math.round(size*canvas.width),1)),height=Math.
max(Math.round(size*views[0].canvas.height),1),all=new OffscreenCanvas(widths.reduce((sum,width)=>sum+width,0),height),pen=all.
getContext("2d",{alpha:!1}),left=0;for(let[n,{canvas}]of views.entries())pen?.drawImage(canvas,left,0,widths[n],height),
left+=widths[n];return all.convertToBlob(format)}var WHITE=[1,1,1],DARK=.5,THEME=["class","style","data-theme","data-jp-\
theme-light","data-vscode-theme-kind"],isDarkWished=()=>matchMedia("(prefers-color-scheme: dark)");function groundAround(element){
let colours=[];for(let at=element;at;){colours.push(getComputedStyle(at).backgroundColor);let root=at.getRootNode();at=at.
parentElement??(root instanceof ShadowRoot?root.host:null)}let pen=new OffscreenCanvas(1,1).getContext("2d",{willReadFrequently:!0});
if(!pen)return WHITE;let{colorScheme}=getComputedStyle(document.documentElement),isDark=colorScheme.includes("dark")&&(!colorScheme.
includes("light")||isDarkWished().matches);for(let colour of[isDark?"#121212":"white",...colours.reverse()])pen.fillStyle=
colour,pen.fillRect(0,0,1,1);return Array.from(pen.getImageData(0,0,1,1).data.subarray(0,3),value=>value/255)}var Ground=class{colour=WHITE;root;changed;constructor(root,lifetime,changed){
this.root=root,this.changed=changed;let look=()=>this.look(),observer=new MutationObserver(look);for(let element of[document.
documentElement,document.body])lifetime.watch(observer,element,{attributeFilter:THEME});lifetime.listen(isDarkWished(),"\
change",look)}look(){let before=String(this.colour);this.update(),String(this.colour)!==before&&this.changed()}update(){
let{root}=this;if(!root.parentElement)return;this.colour=groundAround(root.parentElement);let[r,g,b]=this.colour.map(value=>Math.
round(255*value));root.classList.toggle("flowtex-dark",(.299*r+.587*g+.114*b)/255<DARK),root.style.setProperty("--ground",
`rgb(${r} ${g} ${b})`)}};var STEPS3=[1,2,2.5,5],DEGREES2=[1,2,5,10,15,30,60,90],DECADES=[[1],[1,3],[1,2,5]],SAME2=1e-9,BEYOND2=.004,[LARGE,SMALL2]=[
1e6,.001],LONGEST=7;function ticksOf(low,high,log=!1,most=5){return high-low>SAME2*Math.max(Math.abs(low),Math.abs(high))?
log&&decades(low,high,most)||evenly(low,high,most):Number.isFinite(low)?[{value:low,text:textOf(low,Math.abs(low)/1e3||1)}]:
[]}function offsetOf(low,high,most){let isLong=offset=>ticksOf(low-offset,high-offset,!1,most).some(({text})=>text.length>
LONGEST);if(!isLong(0))return null;let size=Math.max(Math.abs(low),Math.abs(high));for(let power=10**Math.floor(Math.log10(
size));power>high-low;power/=10){let value=Math.round((low+high)/2/power)*power;if(!isLong(value))return{value,text:textOf(
value,power)}}return null}function evenly(low,high,most){let least=10**Math.floor(Math.log10((high-low)/most));for(let power=least;;power*=
10)for(let factor of STEPS3){let step=factor*power,slack=BEYOND2*(high-low),[first,last]=[Math.ceil((low-slack)/step),Math.
floor((high+slack)/step)];if(!(last-first+1>most))return Array.from({length:last-first+1},(_,n)=>{let value=(first+n)*step;
return{value,text:textOf(value,step,Math.max(Math.abs(low),Math.abs(high)))}})}}function degreeTicks(low,high,letters,most=5){
let step=DEGREES2.find(each=>Math.floor(high/each)-Math.ceil(low/each)<most);return(high-low<3*DEGREES2[0]||step===void 0?
ticksOf(low,high,!1,most):Array.from({length:Math.floor(high/step)-Math.ceil(low/step)+1},(_,n)=>{let value=(Math.ceil(low/
step)+n)*step;return{value,text:String(value)}})).map(({value,text})=>{let turned2=value-360*Math.round(value/360),digits=text.
split(".")[1]?.length??0,side=turned2===0||Math.abs(turned2)===180?"":letters[+(turned2<0)];return{value,text:`${Math.abs(
turned2).toFixed(digits)}°${side}`}})}function decades(low,high,most){let[first,last]=[Math.floor(Math.log10(low)),Math.
ceil(Math.log10(high))],powers=Array.from({length:last-first+1},(_,n)=>first+n),isInside=value=>value>=low*(1-SAME2)&&value<=
high*(1+SAME2),valuesOf=(factors,every)=>powers.filter(power=>power%every===0).flatMap(power=>factors.map(factor=>+`${factor}\
e${power}`)).filter(isInside),finer=[...DECADES].reverse().map(factors=>valuesOf(factors,1)),coarser=powers.slice(1).map(
(_,n)=>valuesOf([1],n+2)),chosen=[...finer,...coarser].find(values=>values.length<=most);if(!(!chosen||chosen.length<3))
return chosen.map(value=>({value,text:textOf(value,value,value)}))}function textOf(value,step,size=Math.abs(value)){if(value===
0)return"0";let digits=-Math.floor(Math.log10(step)+SAME2),isHalf=Math.abs(step*10**digits-2.5)<SAME2?1:0;if(size>=LARGE||
size<SMALL2){let mantissa=Math.max(Math.floor(Math.log10(Math.abs(value))+SAME2)+digits+isHalf,0),[number,power]=value.toExponential(
Math.min(mantissa,15)).split("e");return`${minus(number)}e${Number(power)}`}return minus(value.toFixed(Math.max(digits+isHalf,
0)))}var minus=text=>text.replace("-","−");var PARTS=48,LEAST_SHARE=.999,SAME_LATITUDE=.1,[POLE_SHARE,HALF_TURN]=[1/64,180.1],MOST_BACK=.02,[LETTER_PX,GAP_PX,ROW_PX]=[
6.5,14,34],[TICK_PX,LINE_PX]=[4,13],ASIDE_PX=42,[MOST_TICKS,BAR_PX,BAR_SHARE]=[9,140,.3],MIDDLE_SHARE=.02,COORDINATES=["\
x","y","z"],fitting=(name,room)=>name.length*LETTER_PX>room?name.replace(/ .*/,""):name;function placedTicks({values,letters},most){
let finite=values.filter(Number.isFinite);if(finite.length<2)return[];let[low,high]=[Math.min(...finite),Math.max(...finite)];
return(letters?degreeTicks(low,high,letters,most):ticksOf(low,high,!1,most)).flatMap(tick=>{let n=values.findIndex((value,at)=>isBetween(
tick.value,value,values[at+1]));if(n<0)return[];let part=(tick.value-values[n])/(values[n+1]-values[n]||1);return[{...tick,
share:(n+part)/(values.length-1)}]})}var isBetween=(value,a,b)=>Math.min(a,b)<=value&&value<=Math.max(a,b);function hasTicks({
geometry,earth}){return geometry.planar&&(!earth||earth.map!==null)}var Axes=class{element=shape("svg",{class:"axes","ar\
ia-hidden":"true"});host;constructor(host){this.host=host}draw(kind){let{header,camera,stage}=this.host;this.element.replaceChildren();
let[width,height]=[stage.clientWidth,stage.clientHeight];if(kind==="none"||!header||!camera||!width||!height)return;if(this.
element.style.cssText=`width: ${width}px; height: ${height}px`,kind==="scale")return this.drawBar(header,camera,width,height);
let below=borderOf(this.host,[-1,-1],[1,-1]),aside=borderOf(this.host,[-1,-1],[-1,1]);below&&this.drawBelow(below,width,
height),aside&&this.drawAside(aside,height)}drawBelow(border,width,height){let{name,offset}=border,shown=name&&offset?name.
replace(/^\w+/,`$& − ${offset}`):name,isTooWide=ticks2=>ticks2.some(({share,text},n)=>{let apart=n?Math.abs(share-ticks2[n-
1].share)*width:width,letters=Math.max(text.length,ticks2[n-1]?.text.length??0),between3=offset&&n&&n===ticks2.length-1?
(shown?.length??0)*LETTER_PX+GAP_PX:0;return apart<letters*LETTER_PX+GAP_PX+between3}),most=MOST_TICKS,ticks=placedTicks(
border,most);for(;most>2&&ticks.length&&isTooWide(ticks);)ticks=placedTicks(border,most-=1);for(let{share,text}of ticks)
this.line(share*width,height,share*width,height+TICK_PX),this.text(share*width,height+TICK_PX+2,text,"below");let[before,
last]=ticks.slice(-2);if(!shown||!last)return;let middle=(before.share+last.share)/2*width,room=(last.share-before.share)*
width-LETTER_PX*last.text.length-GAP_PX;this.text(middle,height+TICK_PX+2,offset?shown:fitting(shown,room),"below name")}drawAside(border,height){
let{name,offset}=border,row2=ROW_PX+(offset?LINE_PX:0),most=Math.min(Math.max(Math.floor(height/row2),2),MOST_TICKS),ticks=placedTicks(
border,most);for(let{share,text}of ticks){let y=(1-share)*height;this.line(-TICK_PX,y,0,y),this.text(-TICK_PX-3,y,text,"\
aside")}let[before,last]=ticks.slice(-2);if(!name||!last)return;let middle=(1-(before.share+last.share)/2)*height,lines=offset?
[name.replace(/( .*)?$/," −"),offset]:[fitting(name,ASIDE_PX)];lines.forEach((words,n)=>{this.text(-TICK_PX-3,middle+LINE_PX*
(n-(lines.length-1)/2),words,"aside name")})}drawBar(header,camera,width,height){let{earth,lengthUnit}=header,pixel=2*camera.
height/height*scaleOf(this.host,header,camera),most=Math.min(BAR_PX,BAR_SHARE*width)*pixel,power=10**Math.floor(Math.log10(
most)),size=power*([5,2].find(factor=>factor*power<=most)??1),[x,y]=[size/pixel,height+TICK_PX+4];this.line(0,y,x,y);for(let end of[
0,x])this.line(end,y-TICK_PX,end,y+TICK_PX);let isLong=(earth!==null||lengthUnit==="m")&&size>=1e3,text=withUnit(String(
Number((isLong?size/1e3:size).toPrecision(3))),isLong?"km":lengthUnit);this.text(x+8,y-5,text,"beside")}line(x1,y1,x2,y2){
let ends2=Object.entries({x1,y1,x2,y2}).map(([name,value])=>[name,value.toFixed(1)]);this.element.append(shape("line",Object.
fromEntries(ends2)))}text(x,y,words,kind){let place={x:x.toFixed(1),y:y.toFixed(1),class:kind};this.element.append(shape(
"text",place,[document.createTextNode(words)]))}};function scaleOf({parts},header,camera){let{earth}=header;if(!earth?.map)
return 1;let[a,b]=[-1,1].map(x=>pointInPlane(header.geometry,camera,MIDDLE_SHARE*x,0)),[from,to]=[a,b].map(place=>lonLatOf(
earth,place,parts.get("lonlat")));if(!from||!to)return 1;let[east,north]=[to[0]-from[0],to[1]-from[1]].map(degrees=>degrees*
Math.PI/180),middle=(from[1]+to[1])/2*Math.PI/180;return Math.hypot(Math.sin(east/2)*2*Math.cos(middle),north)*earth.radius/
length2(subtract2(b,a))||1}function borderOf(host,from,to){let{header,camera,parts}=host;if(!header||!camera||!hasTicks(
header))return null;let places=Array.from({length:PARTS+1},(_,n)=>pointInPlane(header.geometry,camera,from[0]+(to[0]-from[0])*
n/PARTS,from[1]+(to[1]-from[1])*n/PARTS)),{earth,lengthUnit}=header;if(earth?.map){let along2=from[1]===to[1]?0:1,degrees=degreesAlong(
{...earth,map:earth.map},places,along2,parts.get("lonlat")),values2=unwrapped(degrees);return goesOneWay(values2)?{letters:along2?
"NS":"EW",values:values2}:null}let way=subtract2(places[PARTS],places[0]),axis=way.map(Math.abs).indexOf(Math.max(...way.
map(Math.abs)));if(Math.abs(way[axis])<LEAST_SHARE*length2(way))return null;let[right,up]=camera.axes,border=from[1]===to[1]?
right:up,normal=header.geometry.frame.slice(6).map(Math.abs),across=[0,1,2].find(n=>n!==axis&&n!==normal.indexOf(Math.max(
...normal)));if(Math.abs(border[across??0])>1-LEAST_SHARE)return null;let name=withUnit(COORDINATES[axis],lengthUnit&&`(${lengthUnit}\
)`),values=places.map(place=>place[axis]),offset=offsetOf(Math.min(...values),Math.max(...values),MOST_TICKS);return{name,
offset:offset?.text,values:values.map(value=>value-(offset?.value??0))}}function degreesAlong(earth,places,along2,lonlat){
let[low,high]=[earth.map.slice(0,2),earth.map.slice(2)],[width,height]=low.map((c,n)=>high[n]-c),read=(x,y)=>lonLatOf(earth,
[x,y,0],lonlat)??[NaN,NaN],middle=low[0]+width/2,[one,other]=[middle,low[0]+width/4].map(x=>read(x,low[1]+height/4)[1]),
isStraight=Math.abs(one-other)<SAME_LATITUDE;return places.map(([x,y])=>{if(along2?y<low[1]||y>high[1]:x<low[0]||x>high[0])
return NaN;if(!isStraight)return read(clamp(x,low[0],high[0]),clamp(y,low[1],high[1]))[along2];if(along2)return read(middle,
y)[1];let row2=clamp(y,low[1]+POLE_SHARE*height,high[1]-POLE_SHARE*height),[from,to]=[0,1/64].map(share=>read(middle+share*
width,row2)[0]),away=64*((to-from+540)%360-180)*(x-middle)/width;return Math.abs(away)<HALF_TURN?from+away:NaN})}function goesOneWay(values){
let finite=values.filter(Number.isFinite),steps=finite.slice(1).map((value,n)=>value-finite[n]),[rise,fall]=[1,-1].map(sign=>steps.
reduce((sum,step)=>sum+Math.max(sign*step,0),0));return Math.min(rise,fall)<MOST_BACK*Math.max(rise,fall)}function unwrapped(degrees){
let turns=0;return degrees.map((value,n)=>(n&&Number.isFinite(value-degrees[n-1])&&(turns-=Math.round((value-degrees[n-1])/
360)),value+360*turns))}var STOPS=9,PLAIN="none",LINE_NAMES={coastlines:"Coastlines",graticule:"Graticule"},labelled=(name,input)=>dom("label",{
class:"row"},[dom("span",{class:"name"},[name]),input]),ColourControls=class{element=dom("div",{class:"colours"});viewer;scalars=dom(
"select",{"aria-label":"Colour by"});swatches=dom("div",{class:"swatches",role:"group","aria-label":"Colour map"});ends=[
"Lowest value","Highest value"].map(name=>dom("input",{type:"number",step:"any","aria-label":name}));auto=dom("button",{
type:"button",class:"link"},["auto"]);robust=dom("button",{type:"button",class:"link"},["robust"]);log=dom("input",{type:"\
checkbox",role:"switch"});opacity=dom("input",{type:"range",min:"0",max:"1",step:"0.05"});logRow=labelled("Log scale",this.
log);opacityRow=labelled("Opacity",this.opacity);mapRow;rangeRow;lines=dom("div",{class:"colours"});constructor(viewer){
this.viewer=viewer;let{scalars,swatches,ends:ends2,auto}=this,{lifetime}=viewer;lifetime.listen(scalars,"change",()=>{let name=scalars.
value===PLAIN?!1:scalars.value;viewer.header&&viewer.chooseColours(choiceOf(viewer.header,name))});for(let end of ends2)
lifetime.listen(end,"change",()=>this.takeRange());lifetime.listen(auto,"click",()=>viewer.chooseColours({clim:null})),lifetime.
listen(this.robust,"click",()=>viewer.chooseColours({clim:"robust"})),lifetime.listen(this.log,"change",()=>viewer.chooseColours(
{log_scale:this.log.checked})),lifetime.listen(this.opacity,"input",()=>viewer.chooseColours({opacity:this.opacity.valueAsNumber})),
this.robust.title="Ignore the lowest and the highest values.",lifetime.listen(swatches,"click",event=>{let name=event.target.
dataset.cmap;name&&viewer.chooseColours({cmap:name})});let row2=(name,...fields)=>dom("div",{class:"row"},[dom("span",{class:"\
name"},[name]),...fields]);this.rangeRow=row2("Range",dom("span",{class:"between"},[...ends2,auto,this.robust])),this.mapRow=
row2("Colour map",swatches),this.mapRow.classList.add("ranged"),this.opacityRow.classList.add("ranged"),this.element.append(
row2("Colour by",scalars),this.mapRow,this.rangeRow,this.logRow,this.opacityRow)}get rows(){return[this.element,this.lines]}updateLines(){
let{header,parts,lifetime}=this.viewer,names=EARTH_LINES.filter(name=>header?.earth&&parts.has(name));this.lines.hidden=
!names.length,this.lines.children.length!==names.length&&this.lines.replaceChildren(...names.map(name=>{let input=dom("i\
nput",{type:"checkbox",role:"switch"});lifetime.listen(input,"change",()=>this.viewer.chooseColours({[name]:input.checked}));
let label=dom("span",{class:"name"},[LINE_NAMES[name]]);return dom("label",{class:"row","data-lines":name},[label,input])})),
names.forEach((name,n)=>{let input=this.lines.children[n].querySelector("input");input&&(input.checked=header?.earth?.[name]??
!1)})}update(){let{header,parts}=this.viewer;this.updateLines();let maps=parts.get("maps");if(this.element.hidden=!header?.
scalars.choices.length||!maps,!header||!maps||this.element.hidden)return;let{choices,name,auto}=header.scalars,options=[
...choices,{name:PLAIN,label:PLAIN}];this.scalars.replaceChildren(...options.map(each=>dom("option",{value:each.name},[each.
label]))),this.scalars.value=name??PLAIN;let isHosted=this.viewer.options.onColours!==void 0;this.mapRow.hidden=this.rangeRow.
hidden=name===null,this.logRow.hidden=this.mapRow.hidden||!isHosted,this.robust.hidden=!isHosted,this.log.checked=header.
scalars.log,this.opacity.value=String(header.opacity),legendLimits(header.scalars).forEach((value,n)=>{this.ends[n].value=
String(Number(value.toPrecision(4)))}),this.auto.setAttribute("aria-pressed",String(auto)),this.updateSwatches(header,maps.
data)}updateSwatches(header,maps){let{swatches}=this,{maps:names,cmap}=header.scalars;swatches.childElementCount===names.
length&&names.every((name,n)=>name===this.swatch(n).title)||swatches.replaceChildren(...names.map(name=>dom("button",{type:"\
button",title:name,"aria-label":name,"data-cmap":name}))),names.forEach((name,n)=>{let swatch=this.swatch(n);swatch.setAttribute(
"aria-pressed",String(name===cmap)),swatch.style.background=rampOf(mapOf(header,maps,name),header,this.viewer.settings,STOPS)})}swatch(n){
return this.swatches.children[n]}takeRange(){let[low,high]=this.ends.map(end=>end.valueAsNumber);this.rangeRow.title="",
low<high?this.viewer.chooseColours({clim:[low,high]}):this.rangeRow.title=`${numberText(low)} is not below ${numberText(
high)}`;for(let end of this.ends)end.setCustomValidity(this.rangeRow.title)}};var SLIDER_STOPS=400;function hasStreaming({slices,image,variant}){return slices.steps===1&&!image&&!isSignFree({variant})}
var USES={motion:hasStreaming,speed:hasStreaming,speed_in:hasStreaming,period:hasStreaming,grain:({image})=>!image||!!image.
deviations,fixed_grain:({image})=>!image,two_sided:({slices})=>slices.sides===2,seed:({image},rebuild)=>!image||!!image.
deviations&&rebuild,resolution:({image},rebuild)=>!image||!!image.deviations&&rebuild,tiles:({image})=>!!image&&!image?.
deviations,lines:({slices},rebuild)=>slices.steps>1&&rebuild,parameter:({slices,settings},rebuild)=>rebuild&&(slices.steps===
1||settings.lines!=="pathlines"),critical_points:({structure})=>!!structure?.parts.includes("critical"),separatrices:({structure})=>!!structure?.
parts.includes("separatrices"),nullclines:({structure})=>!!structure?.parts.includes("nullclines"),lod:()=>!1,show_level:()=>!1};
function isUseful({name,affects},header,rebuild){return USES[name]?.(header,rebuild)??(affects==="uniform"||rebuild)}function isInUse({
needs=[]},settings){let holds=needs.map(([name,sign,value])=>settings[name]===value==(sign==="=="));return!needs.length||
holds.includes(!0)}var Controls=class{element=dom("div",{class:"settings glass",hidden:"",role:"group","aria-label":"Set\
tings"});viewer;controls=new Map;rows=null;constructor(viewer){this.viewer=viewer}build(header){let rebuild=this.viewer.
options.rebuild??!1,rows=header.table.filter(each=>isUseful(each,header,rebuild)),kindOf=some=>JSON.stringify(some?.map(
row2=>({...row2,default:null})));if(kindOf(rows)===kindOf(this.rows))return!1;this.rows=rows;let focused=[...this.controls.
values()].find(({input})=>input.matches(":focus"));this.controls.clear(),this.element.replaceChildren();for(let row2 of rows){
let control=this.control(row2),{input,output}=control;input.setAttribute("aria-label",row2.label);let name=dom("span",{class:"\
name"},[row2.label]),attributes={class:"row","data-setting":row2.name},line=dom("label",attributes,[name,...output?[output]:
[],input]);line.classList.toggle("ranged",output!==void 0),this.controls.set(row2.name,{...control,row:row2,line}),this.
element.append(line)}return focused&&this.controls.get(focused.row.name)?.input.focus(),!0}get parameters(){return[...this.
controls.values()].filter(({row:row2})=>row2.name.startsWith("formula.")).map(({line})=>line)}update(){let{settings}=this.
viewer;for(let[name,{row:row2,line,show}]of this.controls){name in settings&&show(settings[name]);let isIdle=!isInUse(row2,
settings);line.classList.toggle("idle",isIdle),line.title=isIdle?`${row2.condition} ${row2.text}`:row2.text}}control(row2){
return row2.control==="checkbox"?this.switch(row2):row2.control==="choice"?this.menu(row2):row2.control==="number"?this.
numberField(row2):this.slider(row2)}switch({name}){let input=dom("input",{type:"checkbox",role:"switch"});return this.viewer.
lifetime.listen(input,"change",()=>this.viewer.choose(name,input.checked)),{input,show:value=>{input.checked=!!value}}}menu({
name,choices}){let options=choices.map(choice=>dom("option",{value:choice},[choice])),input=dom("select",{},options);return this.
viewer.lifetime.listen(input,"change",()=>this.viewer.choose(name,input.value)),{input,show:value=>{input.value=String(value)}}}numberField({
name,whole,low,high}){let[min,max]=[low??0,high??1],step=whole?"1":"any",input=dom("input",{type:"number",min:String(min),
max:String(max),step});return this.viewer.lifetime.listen(input,"change",()=>{let{valueAsNumber:value}=input;Number.isFinite(
value)&&this.viewer.choose(name,clamp(value,min,max))}),{input,show:value=>{input.value=String(value)}}}slider(row2){let{
toSlider,fromSlider,min,max,step}=scaleOf2(row2),range={min:String(min),max:String(max),step:String(step)},input=dom("in\
put",{type:"range",...range}),output=dom("output"),value=()=>fromSlider(Number(input.value)),write=shown=>{output.textContent=
numberText(Number(shown))};this.viewer.lifetime.listen(input,"input",()=>write(value()));let kind=row2.affects==="unifor\
m"?"input":"change";return this.viewer.lifetime.listen(input,kind,()=>this.viewer.choose(row2.name,value())),{input,output,
show:shown=>{input.value=String(toSlider(Number(shown))),write(shown)}}}};function scaleOf2(row2){let{low,high,whole,logarithmic}=row2,
[least,most]=[low??0,high??1],toSlider=value=>logarithmic?Math.log2(value):value,fromSlider=place=>{let value=logarithmic?
2**place:place;return whole?Math.round(value):Number(clamp(value,least,most).toPrecision(3))},[min,max]=[least,most].map(
toSlider),step=whole&&!logarithmic?1:(max-min)/SLIDER_STOPS;return{toSlider,fromSlider,min,max,step}}var isShown=element=>element.getClientRects().length>0,Focus=class{had=[];current=null;fallback;constructor(scope,lifetime,fallback){
this.fallback=fallback,lifetime.listen(scope,"focusin",({target})=>{let element=target;this.had=this.had.filter(each=>each!==
element&&each.isConnected),this.had.push(element),this.current=element}),lifetime.listen(scope,"focusout",({target})=>{queueMicrotask(
()=>{this.current===target&&isShown(this.current)&&(this.current=null)})})}keep(){let lost=this.current;if(!lost||isShown(
lost))return;let shown=this.had.filter(isShown);(shown.length?shown[shown.length-1]:this.fallback(lost))?.focus({preventScroll:!0})}};var TITLE="Keys and the mouse",HELP=[["drag","pan a flat surface, turn a curved one"],["Shift and drag","the opposite: t\
urn, or pan"],["wheel, two fingers","zoom to the pointer"],["click","values and path of a point"],["arrows","pan"],["+ a\
nd -","zoom"],["space","play or pause"],[", and .","a step back or on"],["0","the whole surface"],["d","level of detail \
on or off"],["h","the bar of controls"],["f","full screen"],["?","these keys"],["Esc","close panels and messages"]],Help=class{element;button=dom(
"button",{type:"button",class:"link"},["Close"]);constructor(close){let rows=HELP.flatMap(([keys,effect])=>[dom("dt",{},
[keys]),dom("dd",{},[effect])]),attributes={class:"help glass",role:"dialog","aria-label":TITLE,hidden:""},head=dom("div",
{class:"first"},[dom("strong",{},[TITLE]),this.button]);this.element=dom("div",attributes,[head,dom("dl",{},rows)]),this.
button.addEventListener("click",close)}show(shown){this.element.hidden=!shown,shown&&this.button.focus()}};function helpButton(root,key){
let button=dom("button",{type:"button",class:"link"},[`${TITLE} (${key})`]),press={key,bubbles:!0,composed:!0,cancelable:!0};
return button.addEventListener("click",()=>root.dispatchEvent(new KeyboardEvent("keydown",press))),button}var CAMERA_KEYS={ArrowLeft:"left",ArrowRight:"right",ArrowUp:"up",ArrowDown:"down","+":"closer","=":"closer","-":"farthe\
r",_:"farther",0:"whole",d:"detail",".":"next",",":"previous"},PLAY_KEY=" ",FULLSCREEN_KEY="f",CLOSE_KEY="Escape",HELP_KEY="\
?",DIRECTIONS={left:[-1,0],right:[1,0],up:[0,1],down:[0,-1]};function hasModifier(event){return event.ctrlKey||event.metaKey||
event.altKey}var SLIDER_KEYS=/^(Arrow|Page|Home$|End$)/;function isOfControl(control,key){if(key===CLOSE_KEY||!(control instanceof
Element))return!1;let{tagName,type}=control;return tagName==="BUTTON"||type==="checkbox"?key===PLAY_KEY:type==="range"?SLIDER_KEYS.
test(key):tagName==="INPUT"||tagName==="SELECT"}function forwardKeys(root,event){event.target===document.body&&!event.defaultPrevented&&
!root.dispatchEvent(new KeyboardEvent("keydown",event))&&event.preventDefault()}function toggleFullscreen(element){document.
fullscreenElement?document.exitFullscreen():element.requestFullscreen?.().catch(()=>{})}var STOPS2=33,MOST_CHARACTERS=16,END_SHARE=.1,Legend=class{kinds=dom("div",{class:"kinds glass",hidden:""});shownKinds="";place=value=>value;element=dom(
"div",{class:"legend glass",hidden:""});mark=dom("i",{hidden:""});show(header,settings,map){let{name,label,unit:unit3,bar}=header.
scalars;if(this.element.hidden=name===null||!bar||!map||!!settings.show_level,this.element.hidden||!map)return;let ramp=dom(
"div",{class:"ramp"},[this.mark]);ramp.style.background=rampOf(map,header,settings,STOPS2);let[isBelow,isAbove]=beyondEnds(
header.scalars);ramp.classList.toggle("below",isBelow),ramp.classList.toggle("above",isAbove),this.mark.hidden=!0;let place=placeOf(
header.scalars,map);this.place=place;let ticks=legendTicks(header).map(({value,text})=>{let tick=dom("span",{},[text]),share=clamp(
place(value),0,1);tick.style.left=`${100*share}%`;let isAtEnd=Math.abs(share-.5)>.5-END_SHARE;return tick.style.transform=
`translateX(${isAtEnd?-100*share:-50}%)`,tick});this.element.replaceChildren(dom("div",{class:"name"},[unit3?`${label} (${unit3}\
)`:label]),ramp,dom("div",{class:"ticks"},ticks))}showKinds(kinds){let names=kinds.map(({name,color})=>`${name} ${color}`).
join();names!==this.shownKinds&&(this.shownKinds=names,this.kinds.hidden=!names,this.kinds.replaceChildren(...kinds.map(
({name,color,turns,isLine,isGround})=>{let mark=dom("i",{class:turns?"turns":isLine?"line":""});return mark.style.background=
`rgb(${color.map(c=>Math.round(255*c)).join(" ")})`,dom("span",{class:isGround?"ground":""},[mark,name])})))}point(header,value=NaN){
this.mark.hidden=!header||!Number.isFinite(value),!(!header||this.mark.hidden)&&(this.mark.style.left=`${100*clamp(this.
place(value),0,1)}%`)}};function legendTicks({scalars}){if(scalars.ticks.length)return scalars.ticks;let[low,high]=legendLimits(
scalars),ticks=[5,4,3].map(most=>ticksOf(low,high,scalars.log,most)),size=some=>some.reduce((sum,{text})=>sum+text.length,
0);return ticks.find(some=>size(some)<=MOST_CHARACTERS)??ticks[2]}var HEAD={apart:90,length:14,half:5},POINT_RADIUS=6,FREE_RADIUS=20,textOf2=line=>line.map(place=>place.map(v2=>v2.toFixed(
1)).join()).join(" ");function arrowHeads(line,apart=HEAD.apart){let heads=[],due=0;for(let n=line.length-1;n>0;n-=1){let[
[ax,ay],[bx,by]]=[line[n-1],line[n]],size=Math.hypot(bx-ax,by-ay);if(!size)continue;let[ux,uy]=[(bx-ax)/size,(by-ay)/size];
for(;due<size;due+=apart){let[x,y]=[bx-due*ux,by-due*uy],[left,low]=[x-HEAD.length*ux,y-HEAD.length*uy],[wide,tall]=[-HEAD.
half*uy,HEAD.half*ux];heads.push([[x,y],[left+wide,low+tall],[left-wide,low-tall]])}due-=size}return heads}function pathShapes({
path,sampled,point,directed,dots=[]}){let lines=(all,kind)=>all.map(line=>["polyline",{class:kind,points:textOf2(line)}]),
isFree=([[x,y]])=>!point||Math.hypot(x-point[0],y-point[1])>FREE_RADIUS,heads=directed?path.flatMap(line=>arrowHeads(line)).
filter(isFree):[],ring=kind=>point?[["circle",{class:kind,cx:point[0],cy:point[1],r:POINT_RADIUS}]]:[];return[...lines(path,
"whole-casing"),...lines(path,"whole"),...lines(sampled,"casing"),...lines(sampled,"sampled"),...heads.map(head=>["polyg\
on",{class:"arrow",points:textOf2(head)}]),...dots.map(({place:[cx,cy],radius,grey})=>{let fill=`rgb(${[grey,grey,grey].
map(x=>Math.round(255*x)).join()})`;return["circle",{class:"dot",cx,cy,r:radius,fill}]}),...ring("point-casing"),...ring(
"point")]}var SAMPLE_DIGITS=2;function lagText(lag,unit3){let text=withUnit(numberText(Math.abs(lag),SAMPLE_DIGITS),unit3);
return lag===0?"here":lag>0?`${text} behind`:`${text} ahead`}function sampleText({lag,weight,noise},unit3){let share=`we\
ight ${numberText(weight,SAMPLE_DIGITS)}`,value=noise===null?[]:[`noise ${numberText(noise,SAMPLE_DIGITS)}`];return[lagText(
lag,unit3),share,...value].join(", ")}function sampleChart(samples,unit3){let most=Math.max(...samples.map(({weight})=>weight)),
bars=samples.map(sample=>{let bar=dom("i"),level=Math.round(255*sample.grey);bar.style.height=`${100*sample.weight/most}\
%`,bar.style.background=`rgb(${[level,level,level].join()})`;let words=sampleText(sample,unit3);return dom("li",{title:words},
[bar,dom("span",{class:"unseen"},[words])])}),count2=samples.length===1?"1 sample":`${samples.length} samples`,ends2=[samples[0],
samples[samples.length-1]].map(({lag})=>dom("span",{},[lagText(lag,unit3)]));return dom("div",{class:"samples"},[dom("di\
v",{class:"caption"},[`${count2}: the height is the weight, the grey the noise`]),dom("ol",{"aria-label":"Samples along \
the path"},bars),dom("div",{class:"ends","aria-hidden":"true"},ends2)])}function constantsOf(shader){let lines=shader.matchAll(/^const \w+ FLOWTEX_(\w+) =\s*(?:\w+\()?([^;]*?)\)?;/gm);return Object.
fromEntries(Array.from(lines,([,name,values])=>[name,values.split(",").map(value=>Number(value.trim().replace(/u$/,"")))]))}
function latticeOf(point,octave,u,c){let isOdd=(octave&1)===1,cells=2**(octave>>1),inverse2=(isOdd?Math.SQRT1_2:1)/cells/
Number(u.u_noiseFinest),finest=isOdd?u.u_noiseOriginOdd:u.u_noiseOriginEven,past=isOdd?u.u_noiseRestOdd:[0,0,0],origin=finest.
map(n=>Math.floor(n/cells)),rest=finest.map((n,axis)=>(n-origin[axis]*cells+past[axis])/cells),key=origin.map((n,axis)=>Math.
imul(n,c.AXIS_PRIMES[axis])),salt=Math.imul(octave,c.OCTAVE_PRIME[0])+Math.imul(Number(u.u_seed),c.SEED_PRIME[0]);return key[0]+=
salt,{here:add(rest,point,inverse2),inverse:inverse2,key,origin,salt}}function scatter(key,c){let whole=key>>>0;return Math.
imul(whole^whole>>>c.HASH_SHIFT[0],c.HASH_FACTORS[0])}function sparseGrain(cell,{salt},c){let[all]=c.BLOCK_BITS,bits=Math.
floor(all/cell.length),hash=0,place=salt>>>31<<all;cell.forEach((n,axis)=>{let block=n>>>bits,key=Math.imul(block,c.AXIS_PRIMES[axis])+
(axis===0?salt:0);hash^=scatter(key,c),place|=(n&2**bits-1)<<bits*axis,place^=(block&1)<<all});let isBright=Math.imul(hash,
c.HASH_FACTORS[1])>>>32-all===place;return c.MOST_GRAIN[0]*(isBright?c.SPARSE_HIGH[0]:-c.SPARSE_LOW[0])}function octaveAt(lattice,displacement,c,axes,isSparse2){
let{here,inverse:inverse2,key,origin}=lattice,sides=add(here,displacement,inverse2).slice(0,axes).map((x,axis)=>{let low=Math.
floor(x),hash=n=>scatter(key[axis]+Math.imul(n,c.AXIS_PRIMES[axis]),c);return{low,hashes:[hash(low),hash(low+1)],shares:[
1-x+low,x-low]}}),sum=0;for(let corner=0;corner<2**axes;corner+=1){let side=axis=>corner>>axis&1,hash=sides.reduce((all,{
hashes},axis)=>all^hashes[side(axis)],0),share=sides.reduce((all,{shares:shares2},axis)=>all*shares2[side(axis)],1),cell=sides.
map(({low},axis)=>origin[axis]+low+side(axis)),grain=isSparse2?sparseGrain(cell,lattice,c):Math.imul(hash,c.HASH_FACTORS[1]);
sum+=share*grain}let spread=(all,{shares:[a,b]})=>all*(1-2*a*b);return sum/Math.sqrt(sides.reduce(spread,1)*c.GRAIN_VARIANCE[0])}
function noiseAround(local,octave,isPlanar,isSparse2,u,c){let point=add(local,scale2(u.u_noiseOrigin,-1)),[fine,coarse]=[
0,1].map(n=>latticeOf(point,octave+n,u,c)),axes=isPlanar?2:3;return displacement=>[octaveAt(fine,displacement,c,axes,isSparse2),
octaveAt(coarse,displacement,c,axes,isSparse2)]}function kernelAt(side,t,parting,u,c){return u.u_kernel===c.KERNEL_BOX[0]?
1:u.u_kernel!==c.KERNEL_RAMP[0]?.5+.5*Math.cos(Math.PI*t):u.u_sides===1?1-t:(.5+.5*side*parting)*(1-side*t)}function sideSteps(layers,side,spacing,count2,parting,u,c){
let lags=u.u_lags,slope=layer=>layers(layer).slice(0,3),by=layers(0)[3]*Number(u.u_unit),first=side*lags.length,end=Math.
min(layers(first+1)[3],lags[lags.length-1]),sign=side?1:-1,[before,after]=[slope(0),slope(first+1)],[from,m]=[0,0],bendAt=()=>scale2(
subtract2(after,before),1/(lags[m]-from)),stepAt=(along2,bend)=>{let least=Math.max(Math.sqrt(length2(bend)*spacing/by),
c.LEAST_SPEED[0]);return spacing/by/Math.max(length2(along2),least)},[lag,step]=[0,stepAt(before,bendAt())],result2=[];for(let k=1;k<
count2+1;k+=1){lag+=step;let alive=clamp((end-lag)/step+1,0,1)*Math.min(count2-k+1,1);if(!alive)break;for(;lag>lags[m]&&
m<lags.length-1;m+=1)[before,from]=[after,lags[m]],after=slope(first+m+2);let bend=bendAt(),at=lateness=>before.map((x,n)=>x+
bend[n]*lateness),weight=alive*kernelAt(sign,k/(count2+1),parting,u,c);result2.push({displacement:scale2(at(lag-from),lag*
sign*by),lag:-sign*lag,weight}),step=stepAt(at(2*lag-from),bend)}return result2}function shared(apart,near,c){let square=apart**
2,decay=c.BELL[0]*square-Math.log(Math.max(near,c.LEAST_SQUARE[0])),bend=c.BELL_BEND[0]*square**2,bent=bend/decay**2,many=Math.
sqrt(Math.PI/(decay*(1+bent*(c.BENT[0]-c.BENT_TWICE[0]*bent)))),few=1+2*Math.exp(-decay-bend);return Math.max(many,few)}
var total=values=>values.reduce((sum,value)=>sum+value,0);function greyOf(value,contrast,c){return 1/(1+Math.exp(-c.TONE_SLOPE[0]*
contrast*value))}function pixelSum({at,settings,camera,rows}){let{header}=at.scene,{geometry,slices,shaders}=header;if(header.
image||isMoving(header,settings,!0))return null;let c=constantsOf(shaders.fragment),focus=camera.state.focal_point,view={
...{eye:camera.eye,between:at.moment[2],time:slices.times[0],clock:0,still:!0},focus,anchor:[0,0,0],density:1,pixel:1},u=uniforms(
header,settings,view),grain=grainAt(at,settings,camera,rows),spacing=Number(u.u_spacing)*grain,layers=layersAt(at),moves=length2(
layers(0).slice(0,3))>c.LEAST_SPEED[0],sides=moves?[...Array(Number(u.u_sides)).keys()]:[],areSparse=isSparse(header,settings),
set=Number(u.u_samples),whole=(u.u_sides===2?Math.floor(set/2):set-1)*stretchAt(at,settings,camera),sine=areSparse&&!isSignFree(
header)?partingAt(at,.5*whole*spacing):0,cosine=Math.sqrt(Math.max(1-sine**2,0)),parting=clamp(2*sine,0,1),together=c.TOGETHER[0]*
cosine/Math.max(Math.abs(sine),c.LEAST_SPEED[0]),count2=whole*Math.min(together,1),[back=[],ahead=[]]=sides.map(side=>sideSteps(
layers,side,spacing,count2,parting,u,c)),own=Math.max(kernelAt(1,0,parting,u,c),c.LEAST_WEIGHT[0]),steps=[...back.reverse(),
{displacement:[0,0,0],lag:0,weight:own},...ahead],octaves=clamp(2*Math.log2(grain/Number(u.u_noiseFinest)),0,c.LAST_OCTAVE[0]),
octave=Math.floor(octaves),late=octaves-octave,local=toFrame(geometry.frame,subtract2(at.position,geometry.center)),noise=noiseAround(
local,octave,geometry.planar,areSparse,u,c),weights2=steps.map(({weight})=>weight),squares=total(weights2.map(weight=>weight**
2)),pairs=weights2.slice(1).map((weight,n)=>weight*weights2[n]),near=total(pairs)/squares,apart=Number(u.u_spacing)*2**(late/
2),shares2=[1-late,late],alone=Math.hypot(...shares2),variance=shares2.map((w,n)=>w**2*shared(apart*Math.SQRT1_2**n,near,
c)),slow=u.u_fade?clamp(layers(2)[3]/Number(u.u_fade),0,1):1,gain=(moves?slow**2*(3-2*slow):0)*alone*total(weights2)/Math.
sqrt(squares*total(variance)),moved=mover(at),lagUnit=layers(0)[3]*slices.lagUnit,samples=steps.map(({displacement,lag,weight})=>{
let[fine,coarse]=noise(displacement),value=(shares2[0]*fine+shares2[1]*coarse)/alone,position=moved(displacement)??at.position,
share=weight/total(weights2);return{position,lag:lag*lagUnit,weight:share,noise:value,grey:greyOf(value,1,c)}}),mean=total(
samples.map(sample=>sample.weight*sample.noise));return{samples,middle:back.length,level:Math.log2(grain/Number(u.u_texel)),
mean,gain,grey:greyOf(gain*mean,Number(settings.contrast),c)}}var TITLE2="Path through this point",FEWEST_DIGITS=4,MOST_DIGITS=14,VELOCITY_DIGITS=3,PATIENCE_MS=5e3,RETRY_MS=40,PLACES_IN_VIEW=200,
DEGREE_M=111195,DOT_RADIUS=8;function vectorText(vector,size,digits,flat){return`(${vector.slice(0,flat?2:3).map(x=>{let value=Math.
abs(x)<10**(-1-digits)*size?0:x;return digits>5?String(Number(value.toPrecision(digits))):numberText(value,digits)}).join(
", ")})`}var liesAcross=({planar,frame})=>planar&&Math.abs(frame[8])>.999;function placeText(position,header,parts,camera,isWithUnit=!1){
let{earth}=header,lonLat=earth&&lonLatOf(earth,position,parts.get("lonlat"));if(lonLat)return lonLatText(lonLat,(camera?.
height??0)/PLACES_IN_VIEW/DEGREE_M);let text=positionText(position,header,camera);return isWithUnit?withUnit(text,header.
lengthUnit):text}function positionText(position,header,camera){let{geometry}=header,zoom=Math.max(camera?.zoom??1,1),digits=Math.
min(Math.ceil(FEWEST_DIGITS+Math.log10(zoom)),MOST_DIGITS),isInPlane=liesAcross(geometry)&&Math.abs(position[2]-geometry.
center[2])<1e-12*geometry.extent;return vectorText(position,geometry.extent,digits,isInPlane)}var PointCard=class{element=dom(
"div",{class:"card glass",role:"region",hidden:""});overlay=shape("svg",{});host;list=dom("dl");chart=dom("div");chosen=null;read=null;asked=0;later=null;hasNumbers=!0;drawn=null;constructor(host){
this.host=host,this.element.setAttribute("aria-label",TITLE2),this.overlay.setAttribute("class","path");let button=dom("\
button",{type:"button",class:"link"},["Close"]);button.addEventListener("click",()=>this.close()),this.element.append(dom(
"div",{class:"first"},[dom("span",{},[TITLE2]),button]),this.list,this.chart)}choose(x,y,until=performance.now()+PATIENCE_MS){
let{lifetime,canPick,options,together}=this.host;if(lifetime.cancel(this.later),!options.streamed&&!canPick&&performance.
now()<until)return this.later=lifetime.later(()=>this.choose(x,y,until),RETRY_MS),null;this.close();for(let{card}of together)
card!==this&&card.begin(x,y,!1);return this.begin(x,y,!0)?.point??null}begin(x,y,hasNumbers){let{options}=this.host;if(this.
hasNumbers=hasNumbers,options.streamed)return this.ask({place:[x,y]}),null;let found=this.host.find(x,y);return found?(hasNumbers&&
options.onPoint?.(found.point),options.reader?this.ask(found.point):(this.chosen=found,this.update()),found):null}async ask(at){
let{options,header}=this.host,number=this.asked+=1,found=await options.reader?.(at,!0).catch(()=>null),{camera}=this.host;
if(number!==this.asked||header!==this.host.header||!header||!camera)return;if(!found?.path)return this.hasNumbers?this.close():
this.clear();"place"in at&&this.hasNumbers&&options.onPoint?.(found.point),this.read=found.point;let{point,path}=found;this.
tell(point,path,header,camera),this.show(path,point.position,[])}show(path,point,samples){this.drawn={path,point,samples},
this.draw()}close(){for(let{card}of this.host.together)card.clear()}clear(){this.host.lifetime.cancel(this.later),this.chosen=
this.read=null,this.asked+=1,this.hide(),this.host.options.explainer?.clear()}hide(){this.drawn=null,this.element.hidden=
!0,this.host.panel.keepFocus(),this.overlay.replaceChildren()}update(){let{chosen}=this;if(this.read)return void this.ask(
this.read);let{options,camera,shown,header,tiles,settings,stage,requests}=this.host;if(!chosen||options.bare||!camera||!shown||
!header)return;let{point,layer,place}=chosen,scene=tiles?.layers.find(({key})=>String(key)===String(layer.key))?.scene,position=point.
position,exact=requests.trajectory(position);if(!scene||scene.missing(shown[0],shown[1]).length){if(!exact)return;let now2={
...exact,sampled:[],directed:!0};return this.tell({...point,values:{}},now2,header,camera),this.show(now2,position,[])}let at={
scene,moment:shown,place,position},pixel={at,settings,camera,rows:stage.clientHeight},summed=exact||options.explainer?void 0:
pixelSum(pixel)?.samples,path={...pathThrough(at,settings,camera,stage.clientHeight),samples:summed,...exact},places=this.
host.parts.get("lonlat"),eastNorth2=velocityOnEarth(at,places)??void 0,speed=exact?void 0:speedAt(at,places),now={...point,
values:valuesAt(scene,shown,place),eastNorth:eastNorth2,speed};this.report(now),this.tell(now,path,header,camera);let samples=options.
explainer?.explain(pixel)??[];this.show(path,position,samples)}report(point){let{chosen}=this;!chosen||!this.hasNumbers||
JSON.stringify(chosen.point.values)===JSON.stringify(point.values)||(this.chosen={...chosen,point:{...chosen.point,values:point.
values}},this.host.options.onPoint?.(this.chosen.point))}tell(point,path,header,camera){let{velocity,samples=[]}=path,{unit:unit3}=header.
speed,{eastNorth:eastNorth2,speed}=point,label=eastNorth2?"speed":header.speed.label,size=Math.hypot(...eastNorth2??velocity),
speedShown=speed??size,lines=new Map,where=placeText(point.position,header,this.host.parts,camera,!0);if(eastNorth2){let[
east,north]=eastNorth2;lines.set("place",where),lines.set("eastward",withUnit(numberText(east,VELOCITY_DIGITS),unit3)),lines.
set("northward",withUnit(numberText(north,VELOCITY_DIGITS),unit3))}else{let text=vectorText(velocity,size,VELOCITY_DIGITS,
liesAcross(header.geometry));lines.set("position",where),lines.set(label.replace("speed","velocity").replaceAll("|",""),
withUnit(text,unit3))}lines.set(label,withUnit(numberText(speedShown,VELOCITY_DIGITS),unit3));for(let[name,value]of Object.
entries(point.values)){let named=header.scalars.choices.find(each=>each.name===name)??header.scalars;lines.set(named.label,
withUnit(numberText(value),named.unit))}point.mark&&lines.set("critical point",point.mark),this.list.replaceChildren(...[
...lines].flatMap(([word,value])=>[dom("dt",{},[word]),dom("dd",{},[value])]));let lagUnit=header.slices.byTime?header.slices.
timeUnit:header.lengthUnit;this.chart.replaceChildren(...samples.length>1?[sampleChart(samples,lagUnit)]:[]),this.element.
hidden=!this.hasNumbers||this.host.options.explainer!==void 0}draw(){let{drawn}=this,{camera,stage}=this.host;if(!drawn||
!camera)return;let{clientWidth:width,clientHeight:height}=stage,placeOf3=point2=>{let place=camera.project(point2);return place&&
[(place[0]+1)/2*width,(1-place[1])/2*height]},linesOf2=points=>{let lines2=[[]];for(let place of points.map(placeOf3))place?
lines2[lines2.length-1].push(place):lines2.push([]);return lines2.filter(line=>line.length>1)},{path,sampled,directed}=drawn.
path,point=placeOf3(drawn.point),{samples}=drawn,most=Math.max(...samples.map(({weight})=>weight)),dots=samples.flatMap(
({position,weight,grey})=>{let place=placeOf3(position);return place?[{place,radius:DOT_RADIUS*Math.sqrt(weight/most),grey}]:
[]}),lines={path:linesOf2(path),sampled:dots.length?[]:linesOf2(sampled)},shapes=pathShapes({...lines,dots,point,directed});
this.overlay.replaceChildren(...shapes.map(([tag,attributes])=>shape(tag,attributes)))}};var styles_default=`/* What is seen around the picture, in the shadow of each view. */
:host {
  --ink: var(--jp-ui-font-color1, #1b2430);
  --quiet: var(--jp-ui-font-color2, #566373);
  --ground: #ffffff; /* that of the page, once it is known */
  --edge: color-mix(in srgb, var(--ink) 14%, transparent);
  --hover: color-mix(in srgb, var(--ink) 9%, transparent);
  --accent: var(--jp-brand-color1, #0f766e);
  --shadow: 0 4px 18px rgb(16 24 40 / 0.16);
  --glass: color-mix(in srgb, var(--ground) 78%, transparent);
  --above-bar: 56px;
  color-scheme: light;
  position: relative;
  display: grid;
  grid-template: auto minmax(0, 1fr) auto / minmax(0, 1fr);
  box-sizing: border-box;
  width: 100%;
  height: 100%;
  overflow: hidden;
  container-type: inline-size;
  color: var(--ink);
  background: var(--ground);
  font: 12px/1.35 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif;
  outline: none;
  user-select: none;
  -webkit-user-select: none;
}
:host(.flowtex-dark) {
  --ink: var(--jp-ui-font-color1, #e8edf2);
  --quiet: var(--jp-ui-font-color2, #a3b0bd);
  --accent: var(--jp-brand-color1, #4fd1c5);
  --shadow: 0 4px 18px rgb(0 0 0 / 0.35);
  color-scheme: dark;
}
:host(:focus-visible)::after {
  content: ""; position: absolute; inset: 0; z-index: 1; pointer-events: none;
  box-shadow: inset 0 0 0 2px var(--accent);
}
:host(:fullscreen) { width: 100vw !important; height: 100vh !important; }
* { box-sizing: border-box; }
[hidden] { display: none !important; }
.picture {
  position: absolute; inset: 0; width: 100%; height: 100%;
  cursor: grab; touch-action: none; display: block;
}
:host(.flowtex-guarded:not(.flowtex-held, :fullscreen)) .picture { touch-action: pan-y pinch-zoom; }
:host(.flowtex-grabbing) .picture { cursor: grabbing; }
.glass {
  background: var(--glass);
  border: 1px solid var(--edge);
  border-radius: 10px;
  box-shadow: var(--shadow);
  backdrop-filter: blur(12px) saturate(1.3);
  -webkit-backdrop-filter: blur(12px) saturate(1.3);
}
/* The picture fills the view, with what else there is upon it, or stands between the two bars. */
.stage { position: relative; grid-area: 1 / 1 / -1 / 1; min-width: 0; min-height: 0; }
.top {
  grid-area: 1 / 1; z-index: 1; display: flex; justify-content: space-between; align-items: flex-start;
  gap: 8px; padding: 10px; pointer-events: none;
}
:host(.flowtex-framed) .stage { grid-row: 2; margin: 0 10px; }
:host(.flowtex-framed) .top { height: 46px; padding: 2px 10px 0; align-items: center; }
:host(.flowtex-framed) { --above-bar: 10px; }
:host(.flowtex-framed) .bar { margin: 4px auto; }
:host(.flowtex-framed) :is(.head, .kinds, .legend, .bar) {
  background: none; border-color: transparent; box-shadow: none;
  backdrop-filter: none; -webkit-backdrop-filter: none;
}
:host(.flowtex-framed) :is(.head, .kinds, .legend) { padding-inline: 0; padding-block: 0; }
:host(.flowtex-framed) .legend { flex: 0 1 240px; }
:host(.flowtex-framed[data-axes="ticks"]) .stage { margin: 0 16px 22px 58px; }
:host(.flowtex-framed[data-axes="scale"]) .stage { margin-bottom: 20px; }
:host(.flowtex-framed[data-axes="ticks"]) .stage::after {
  content: ""; position: absolute; inset: 0; pointer-events: none; box-shadow: 0 0 0 1px var(--edge);
}
.axes { position: absolute; left: 0; top: 0; overflow: visible; pointer-events: none; }
.axes line { stroke: var(--quiet); stroke-width: 1; }
.axes text { fill: var(--quiet); font: 11px system-ui, sans-serif; font-variant-numeric: tabular-nums; }
.axes .below { text-anchor: middle; dominant-baseline: hanging; }
.axes .aside { text-anchor: end; dominant-baseline: central; }
.axes .beside { dominant-baseline: hanging; }
.axes .name { font-style: italic; }
.head {
  max-width: 100%; min-width: 0; flex: 0 1 auto;
  padding: 5px 10px; display: flex; gap: 10px; align-items: baseline;
  pointer-events: none; white-space: nowrap; overflow: hidden;
}
.title { font-weight: 600; overflow: hidden; text-overflow: ellipsis; }
.title:not(.formula)::first-letter { text-transform: uppercase; }
.parameters { display: flex; gap: 12px; min-width: 0; overflow-x: auto; pointer-events: auto; }
.parameters:empty { display: none; }
.parameters .row.row { display: flex; flex: none; gap: 5px; min-height: 0; padding: 0; border: 0; }
.parameters .row input { order: 1; width: 64px; }
.parameters .row output { order: 2; min-width: 4ch; }
.readout, .ticks, .time, .row output { color: var(--quiet); font-variant-numeric: tabular-nums; }
.readout { display: flex; gap: 8px; }
.readout:empty { display: none; }
.head:not(:has(.title:not([hidden]), .parameters:not(:empty), .readout:not(:empty))) { display: none; }
.readout b { color: var(--ink); font-weight: 500; }
/* Sliders keep their room beside the legend. Several, or one beside kinds of marks, wrap, and have a line of their own \
where the view is
   narrow; the readout takes what is left there, as the picture would move if it took more. */
.top:has(.row) .legend { flex-shrink: 9; }
:host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) {
  flex-wrap: wrap; justify-content: flex-end; row-gap: 2px; height: auto; min-height: 46px; padding-top: 0;
}
:host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) :is(.kinds, .legend) { margin-le\
ft: 0; }
:host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) .head { flex: 1 1 auto; flex-flo\
w: row wrap; gap: 0 10px; }
:host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) .parameters { flex-wrap: wrap; g\
ap: 0 12px; }
:host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) .readout {
  flex: 1 1 0; contain: inline-size; margin-left: -10px; padding: 0;
}
:host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) .readout > :first-child { margin\
-left: 10px; }
.legend {
  flex: none; margin-left: auto; min-width: 150px; max-width: 60%; padding: 5px 10px 6px; font-size: 11px;
  pointer-events: none;
}
.legend .name {
  width: 0; min-width: 100%; margin-bottom: 3px; overflow: hidden; overflow-wrap: anywhere;
  display: -webkit-box; -webkit-box-orient: vertical; -webkit-line-clamp: 2;
}
.kinds {
  flex: none; display: grid; grid-template-columns: auto auto; gap: 1px 12px; padding: 5px 10px 6px; font-size: 11px;
  margin-left: auto; pointer-events: none;
}
.kinds:has(:nth-child(5)) { grid-template-columns: auto auto auto; }
.kinds:not([hidden]) + .legend { margin-left: 10px; }
.kinds span { display: flex; align-items: center; gap: 5px; white-space: nowrap; }
.kinds i { width: 9px; height: 9px; border-radius: 50%; box-shadow: 0 0 0 1.5px rgb(16 20 24 / 0.85); }
.kinds .line { width: 14px; height: 3px; border-radius: 1px; }
.kinds .turns::after { content: ""; display: block; width: 4px; height: 4px; margin: 2.5px; border-radius: 50%; backgrou\
nd: #fff; }
.ramp { position: relative; height: 8px; border-radius: 4px; box-shadow: inset 0 0 0 1px var(--edge); }
.ramp.below { --below: 6px; border-radius: 0 4px 4px 0; }
.ramp.above { --above: 6px; border-radius: 4px 0 0 4px; }
.ramp.below.above { border-radius: 0; }
.ramp.below, .ramp.above {
  box-shadow: none;
  clip-path: polygon(
    0 50%, var(--below, 0px) -3px, calc(100% - var(--above, 0px)) -3px, 100% 50%,
    calc(100% - var(--above, 0px)) 11px, var(--below, 0px) 11px
  );
}
.ramp i {
  position: absolute; top: -2px; bottom: -2px; width: 2px; margin-left: -1px; border-radius: 1px;
  background: var(--ink); box-shadow: 0 0 0 1px var(--ground);
}
.ticks { position: relative; height: 1.35em; margin-top: 3px; white-space: nowrap; }
.ticks span { position: absolute; }
:host(.flowtex-framed) .card { top: 8px; max-height: calc(100% - 16px); }
.card {
  position: absolute; left: 8px; top: 52px; max-width: calc(100% - 16px); max-height: calc(100% - 60px); pointer-events:\
 none;
  padding: 5px 6px 7px 10px; overflow: hidden; }
.card button { pointer-events: auto; }
.card .first { display: flex; align-items: center; justify-content: space-between; gap: 10px; }
dl {
  display: grid; grid-template-columns: auto auto; gap: 1px 12px; margin: 2px 4px 0 0;
  font-variant-numeric: tabular-nums;
}
dt { color: var(--quiet); }
dd { margin: 0; text-align: right; white-space: nowrap; }
.samples { margin: 6px 4px 0 0; font-size: 11px; }
.samples .caption, .samples .ends { color: var(--quiet); }
.samples ol {
  display: flex; align-items: flex-end; height: 40px; margin: 3px 0 2px; padding: 0; list-style: none;
  border-bottom: 1px solid var(--quiet); pointer-events: auto;
}
.samples li { display: flex; flex: 1 1 0; align-items: flex-end; min-width: 0; height: 100%; }
.samples i { flex: 1; min-height: 1px; box-shadow: inset 0 0 0 0.5px var(--quiet); }
.samples .ends { display: flex; justify-content: space-between; gap: 12px; white-space: nowrap; }
.unseen { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
.help {
  position: absolute; z-index: 2; inset: 10px; margin: auto; width: fit-content; height: fit-content; max-width: calc(10\
0% - 20px);
  max-height: calc(100% - 20px); overflow-y: auto; overscroll-behavior: contain; padding: 8px 12px 10px; scrollbar-width\
: thin;
  --glass: color-mix(in srgb, var(--ground) 94%, transparent);
}
.help .first { display: flex; align-items: center; justify-content: space-between; gap: 10px; }
.help dt { white-space: nowrap; }
.help dd { text-align: left; white-space: normal; }
.path { position: absolute; inset: 0; width: 100%; height: 100%; pointer-events: none; }
.path :not(.dot) { fill: none; }
.path * { stroke: #000; stroke-linejoin: round; }
.path :is(.casing, .sampled) { stroke-linecap: round; }
.path .whole-casing { stroke-opacity: 0.55; stroke-width: 4; }
.path .whole { stroke: #fff; stroke-width: 1.6; stroke-dasharray: 5 4; }
.path .casing { stroke-opacity: 0.75; stroke-width: 6; }
.path .sampled { stroke: #fff; stroke-width: 2.6; }
.path .arrow { fill: #fff; stroke-width: 1.5; }
.path .dot { stroke: #fff; stroke-width: 1.2; }
.path .point-casing { stroke-width: 5; }
.path .point { stroke: #fff; stroke-width: 2.4; }
.bar {
  grid-area: 3 / 1; z-index: 1; width: fit-content; max-width: calc(100% - 20px); margin: 10px auto;
  display: flex; align-items: center; gap: 1px; padding: 3px;
}
button {
  appearance: none; flex: none; display: grid; place-items: center; width: 30px; height: 30px;
  margin: 0; padding: 0; border: 0; border-radius: 7px; background: none; color: var(--ink);
  cursor: pointer; transition: background-color 0.12s, color 0.12s;
}
button:hover { background: var(--hover); }
button:focus-visible, input:focus-visible, select:focus-visible {
  outline: 2px solid var(--accent); outline-offset: -1px;
}
button[aria-pressed="true"] { color: var(--accent); background: color-mix(in srgb, var(--accent) 14%, transparent); }
svg { width: 18px; height: 18px; pointer-events: none; }
path {
  fill: none; stroke: currentColor; stroke-width: 1.7; stroke-linecap: round; stroke-linejoin: round;
}
path.solid { fill: currentColor; }
.handle {
  position: absolute; left: 50%; bottom: 8px; margin-left: -17px; width: 34px; height: 20px; opacity: 0.35;
}
:host(:hover) .handle, .handle:focus-visible { opacity: 1; }
.handle:hover { background: var(--glass); }
.track { display: flex; align-items: center; gap: 8px; min-width: 90px; width: 260px; flex: 0 1 auto; padding: 0 6px 0 4\
px; }
.time { flex: none; white-space: nowrap; }
.track input:disabled { opacity: 0.45; }
input[type="range"] {
  appearance: none; -webkit-appearance: none; flex: 1; min-width: 0; width: 100%; height: 18px;
  margin: 0; background: none; cursor: pointer; accent-color: var(--accent);
}
input[type="range"]::-webkit-slider-runnable-track { height: 4px; border-radius: 2px; background: var(--edge); }
input[type="range"]::-moz-range-track { height: 4px; border-radius: 2px; background: var(--edge); }
input[type="range"]::-webkit-slider-thumb {
  -webkit-appearance: none; width: 14px; height: 14px; margin-top: -5px; border: 0; border-radius: 50%;
  background: var(--accent); box-shadow: 0 1px 3px rgb(0 0 0 / 0.3);
}
input[type="range"]::-moz-range-thumb {
  width: 14px; height: 14px; border: 0; border-radius: 50%; background: var(--accent);
}
.settings {
  position: absolute; z-index: 2; right: 10px; bottom: 58px; width: 248px;
  max-width: calc(100% - 20px); max-height: calc(100% - 68px); overflow-y: auto; padding: 6px 12px; scrollbar-width: thi\
n;
  overscroll-behavior: contain; --glass: color-mix(in srgb, var(--ground) 90%, transparent);
  background: var(--glass);
}
:host(.flowtex-open:not(.flowtex-framed)) :is(.kinds, .legend) { display: none; }
.row {
  display: grid; grid-template-columns: 1fr auto; align-items: center; column-gap: 10px;
  min-height: 30px; padding: 2px 0;
}
.row.idle:not(:hover, :focus-within) { opacity: 0.45; }
.row.ranged input { grid-column: 1 / -1; }
.row + .row { border-top: 1px solid var(--edge); }
.colours { border-bottom: 1px solid var(--edge); }
.swatches { grid-column: 1 / -1; display: grid; grid-template-columns: repeat(3, 1fr); gap: 5px; padding: 3px 0 5px; }
.swatches button { width: auto; height: 16px; border-radius: 4px; box-shadow: inset 0 0 0 1px var(--edge); }
.swatches button[aria-pressed="true"] { box-shadow: 0 0 0 2px var(--ground), 0 0 0 4px var(--accent); }
.row:has(.between) { grid-template-columns: auto 1fr; column-gap: 6px; }
.between { display: flex; align-items: center; justify-content: flex-end; gap: 2px; }
.between input[type="number"] { width: 48px; padding-inline: 4px; appearance: textfield; }
.between input::-webkit-inner-spin-button { appearance: none; }
.between input:invalid { outline: 2px solid #d43d3d; outline-offset: -1px; }
button.link { width: auto; height: 24px; padding: 0 4px; font: inherit; }
select, input[type="number"] {
  font: inherit; color: var(--ink); background: var(--hover); border: 0; border-radius: 6px;
  padding: 3px 6px; width: 110px; height: 24px;
}
option { color: var(--ink); background: var(--ground); }
input[role="switch"] {
  appearance: none; -webkit-appearance: none; position: relative; width: 30px; height: 18px; margin: 0;
  border-radius: 9px; background: var(--edge); cursor: pointer; transition: background-color 0.15s;
}
input[role="switch"]::after {
  content: ""; position: absolute; left: 2px; top: 2px; width: 14px; height: 14px; border-radius: 50%;
  background: #fff; box-shadow: 0 1px 3px rgb(0 0 0 / 0.35); transition: transform 0.15s;
}
input[role="switch"]:checked { background: var(--accent); }
input[role="switch"]:checked::after { transform: translateX(12px); }
.busy {
  position: absolute; left: 50%; bottom: var(--above-bar); transform: translateX(-50%); padding: 5px 12px;
  border-radius: 10px; background: var(--glass); color: var(--quiet); pointer-events: none;
  animation: appear 1ms 600ms backwards; /* what takes but a moment is not told */
}
@keyframes appear { from { visibility: hidden } }
.hint {
  position: absolute; left: 50%; bottom: var(--above-bar); transform: translateX(-50%); padding: 4px 12px;
  color: var(--quiet); pointer-events: none; white-space: nowrap; max-width: calc(100% - 20px);
  overflow: hidden; text-overflow: ellipsis;
}
.told {
  position: absolute; left: 50%; bottom: var(--above-bar); transform: translateX(-50%); padding: 6px 12px;
  width: max-content; max-width: min(420px, calc(100% - 40px)); cursor: pointer;
}
.note {
  position: absolute; inset: 0; z-index: 3; display: flex; flex-direction: column; align-items: center;
  justify-content: center; gap: 6px; padding: 24px; text-align: center; background: var(--ground);
  overflow: auto; user-select: text; -webkit-user-select: text;
}
.note pre {
  margin: 0; max-width: 100%; white-space: pre-wrap; color: var(--quiet);
  font: 11px/1.4 ui-monospace, Menlo, Consolas, monospace; text-align: left;
}
@container (max-width: 640px) {
  :host(.flowtex-framed) .top:is(:has(.row + .row), :has(.row):has(.kinds:not([hidden]))) .head { flex-basis: 100%; marg\
in-top: 5px; }
}
@container (max-width: 900px) {
  :host(.flowtex-framed) .head:has(.title:not([hidden]) + .parameters > .row:nth-child(3)) { flex-basis: 100%; margin-to\
p: 5px; }
}
@container (max-width: 460px) {
  .bar { flex-wrap: wrap; justify-content: center; }
  .track { order: -1; flex: 1 1 100%; width: auto; }
  .track:has(input:disabled) { display: none; }
  .legend { min-width: 132px; padding: 4px 8px; }
  .settings { bottom: 80px; max-height: calc(100% - 90px); }
  .head { flex-direction: column; gap: 0; }
  .head > * { max-width: 100%; padding-right: 2px; overflow: hidden; text-overflow: ellipsis; }
  :host(.flowtex-framed[data-axes="ticks"]) .stage { margin-left: 56px; margin-right: 8px; }
}
/* Of a narrow view the legend names what has no data, in one column, and no kinds of marks. */
@container (max-width: 420px) {
  :host(:not(.flowtex-framed)) .kinds:not(:has(.ground)), .top:not(:has(.row)) .kinds:not(:has(.ground)) { display: none\
; }
  :host(:not(.flowtex-framed)) .kinds span:not(.ground), .top:not(:has(.row)) .kinds span:not(.ground) { display: none; \
}
  :host(:not(.flowtex-framed)) .kinds, .top:not(:has(.row)) .kinds { grid-template-columns: auto; gap: 0; padding: 4px 6\
px; }
}
@container (max-width: 220px) { :host(:not(.flowtex-tiny)) .top:has(.row) .legend, .top:not(:has(.row)) .head { display:\
 none; } }
:host(.flowtex-tiny) :is(.head, .kinds), :host(.flowtex-small:not(.flowtex-framed)) :is(.kinds, .legend) { display: none\
; }
/* A small view leaves most of its height to the flow: the legend has its name beside it, and the bar one line. */
:host(.flowtex-small.flowtex-framed) .top { height: 28px; padding-top: 0; }
:host(.flowtex-small.flowtex-framed) .legend {
  display: grid; grid-template-columns: minmax(0, max-content) 140px; column-gap: 10px; align-items: center;
  flex: 0 1 auto; min-width: 140px; max-width: none;
}
:host(.flowtex-small.flowtex-framed) .legend[hidden] { display: none; }
:host(.flowtex-small.flowtex-framed) .legend .name {
  grid-row: span 2; width: auto; min-width: 0; margin: 0; overflow-wrap: normal; word-break: break-all; -webkit-line-cla\
mp: 1;
}
:host(.flowtex-small.flowtex-framed) .ticks { margin-top: 1px; }
:host(.flowtex-small.flowtex-framed) .bar {
  flex-wrap: nowrap; margin: 1px auto; padding: 0; overflow-x: auto; justify-content: safe center; scrollbar-width: none\
;
}
:host(.flowtex-small.flowtex-framed) .bar button { height: 26px; }
:host(.flowtex-small.flowtex-framed) .track { order: 0; flex: 0 1 auto; }
:host(.flowtex-small.flowtex-framed) .settings { bottom: 34px; max-height: calc(100% - 40px); }
@container (max-width: 240px) {
  :host(.flowtex-small.flowtex-framed) .legend { grid-template-columns: 140px; }
  :host(.flowtex-small.flowtex-framed) .legend .name { display: none; }
}
:host(.flowtex-tiny) .legend { min-width: 0; max-width: 100%; }
:host(.flowtex-tiny.flowtex-framed) .top { height: auto; }
@container (max-width: 330px) { button { width: 27px; height: 27px; } }
:host(.flowtex-bare) :is(.top, .path, .card, .settings, .help, .bar, .handle) { display: none; }
`;var HINT_MS=1600,LATE_MS=4e3,SAVED_MS=5e3,[SMALL_PX,TINY_PX]=[280,160],PACES=[.25,.5,1,2,4],KEY=/Mac|iP(hone|ad)/.test(navigator.
platform)?"⌘":"Ctrl",HINT=`Click, or hold ${KEY}, to zoom with the wheel`,TIME_RANGE={min:"0",max:"1",step:"any","aria\
-label":"Time"},FORBIDDEN=/[\\/:*?"<>|]+/g,styleSheet=new CSSStyleSheet;styleSheet.replaceSync(styles_default);var Panel=class{viewer;legend=new Legend;axes;axesMenu=dom(
"select",{},AXES.map(kind=>dom("option",{},[kind])));axesRow=dom("label",{class:"row"},[dom("span",{class:"name"},["Axes"]),
this.axesMenu]);paceMenu=dom("select",{},PACES.map(pace=>dom("option",{value:`${pace}`},[`${pace}×`])));paceRow=dom("la\
bel",{class:"row",title:"Speed of the animation."},[dom("span",{class:"name"},["Pace"]),this.paceMenu]);controls;colours;isShown;axesKind=null;isOpen=!1;legendLook="";title=dom(
"div",{class:"title"});readout=dom("div",{class:"readout",role:"status"});parameters=dom("div",{class:"parameters"});head=dom(
"div",{class:"head glass",hidden:""},[this.title,this.parameters,this.readout]);note=dom("div",{class:"note",hidden:"",role:"\
alert"});doing=dom("span",{role:"status"});count=dom("span",{"aria-hidden":"true"});busy=dom("div",{class:"busy",hidden:""},
[this.doing,this.count]);told=dom("div",{class:"told glass",hidden:"",role:"status"});words=new Set;hintBox=dom("div",{class:"\
hint glass",hidden:""},[HINT]);bar;handle;playButton;stepButtons;toggles;gear;slider=dom("input",{type:"range",...TIME_RANGE});timeText=dom(
"span",{class:"time"});track=dom("div",{class:"track"},[this.slider,this.timeText]);hintTimer=null;lateTimer=null;isFinding=!1;help=new Help(
()=>this.showHelp(!1));helpRow;focus;constructor(viewer){this.viewer=viewer;let{root,stage,canvas,options}=viewer;this.isShown=
options.controls??!0,this.axes=new Axes(viewer),viewer.lifetime.listen(this.axesMenu,"change",()=>{let kind=this.axesMenu.
value;for(let{panel}of viewer.together)panel.chooseAxes(kind);options.onAxes?.(kind)}),this.controls=new Controls(viewer),
this.colours=new ColourControls(viewer),this.handle=this.button("show","Show the bar (h)",()=>this.toggle()),this.handle.
classList.add("handle","glass"),this.playButton=this.button("play","Play (space)",()=>viewer.togglePlaying()),this.stepButtons=
[this.button("previous","Step back (,)",()=>viewer.step(-1)),this.button("next","Step forward (.)",()=>viewer.step(1))],
viewer.lifetime.listen(this.paceMenu,"change",()=>viewer.player.pace=Number(this.paceMenu.value)),viewer.lifetime.listen(
this.slider,"input",()=>viewer.scrub(Number(this.slider.value)));let toggle=name=>()=>viewer.choose(name,!viewer.settings[name]);
this.toggles={lod:this.button("lod","Level of detail",toggle("lod")),show_level:this.button("levels","Show level",toggle(
"show_level"))},this.gear=this.button("settings","Settings",()=>this.fold(!this.isOpen)),this.bar=this.makeBar(),canvas.
className="picture",root.classList.toggle("flowtex-bare",options.bare??!1);let shadow=root.attachShadow({mode:"open"});shadow.
adoptedStyleSheets=[styleSheet];let{legend,controls,head,bar,handle,busy,hintBox,told,note}=this,{card}=viewer;stage.className=
"stage",stage.append(canvas,card.overlay,this.axes.element,card.element,busy,hintBox,told),shadow.append(dom("div",{class:"\
top"},[head,legend.kinds,legend.element]),stage,bar,handle),shadow.append(controls.element,this.help.element,note),this.
helpRow=dom("div",{class:"row"},[helpButton(root,HELP_KEY)]),this.focus=new Focus(shadow,viewer.lifetime,lost=>this.afterFocus(
lost)),viewer.lifetime.listen(told,"click",()=>told.hidden=!0),this.arrange()}button(name,title,press){let button=dom("b\
utton",{type:"button",title,"aria-label":title,"data-name":name},[icon(name)]);return this.viewer.lifetime.listen(button,
"click",press),button}makeBar(){let{viewer}=this;return dom("div",{class:"bar glass",role:"toolbar","aria-label":"Contro\
ls"},[this.stepButtons[0],this.playButton,this.stepButtons[1],this.track,this.button("home","Show everything (0)",()=>viewer.
reset()),this.toggles.lod,this.toggles.show_level,this.gear,this.button("save","Save the picture",()=>{this.save()}),this.
button("full","Fill the screen (f)",()=>this.fullscreen()),this.button("hide","Hide the bar (h)",()=>this.toggle())])}build(){
let{header}=this.viewer;if(!header)return;this.note.hidden=!0;let isOther=this.controls.build(header);isOther&&this.controls.
element.prepend(...this.colours.rows,this.axesRow,this.paceRow),isOther&&this.controls.element.append(this.helpRow),isOther&&
this.parameters.replaceChildren(...this.controls.parameters),this.showLegend(),this.update(),this.arrange()}update(){let{
header,settings}=this.viewer,{playing,varies}=this.viewer.player;this.name(),this.controls.update();let isMarked=this.viewer.
options.streamed&&Number(settings.critical_points)>0;this.viewer.options.streamed&&this.showKinds(isMarked&&header?.structure?.
kinds||[]),this.legendLook!==this.lookOf(settings)&&this.showLegend();for(let[name,button]of Object.entries(this.toggles))
button.setAttribute("aria-pressed",String(!!settings[name]));let title=playing?"Pause (space)":"Play (space)";this.playButton.
replaceChildren(icon(playing?"pause":"play")),this.playButton.title=title,this.playButton.setAttribute("aria-label",title);
let streams=header!==null&&hasStreaming(header);this.playButton.hidden=this.track.hidden=this.paceRow.hidden=!varies&&!streams;
for(let button of this.stepButtons)button.hidden=!varies;this.paceMenu.value=String(this.viewer.player.pace),this.slider.
disabled=!varies&&settings.motion==="off";let width=header&&this.date(header)?.length||8+withUnit("",header?.slices.timeUnit??
"").length;this.timeText.style.minWidth=`${varies?width:7}ch`,this.tick()}name(){let{header,settings,root,options}=this.
viewer,differences=(header?.differs??[]).filter(name2=>name2 in settings).map(name2=>{let label2=header?.table.find(row2=>row2.
name===name2)?.label??name2,value=settings[name2];return`${label2}: ${typeof value=="boolean"?value?"on":"off":value}`}),
name=header?.name??"",title=differences.join(", ")||(options.named&&this.viewer.together.length<2?"":name),{first}=this,
isApart=first!==this.viewer.player&&this.viewer.player.time!==first.time,moment=header&&isApart&&this.viewer.player.varies?
this.moment(header):"";this.title.textContent=[title,moment].filter(Boolean).join(" · "),this.title.hidden=!this.title.
textContent,this.title.classList.toggle("formula",/[=(]/.test(title));let label=options.label??(title||name);root.setAttribute(
"aria-label",label?`Flow texture: ${label}`:"Flow texture")}get first(){return this.viewer.together[0]?.player??this.viewer.
player}tick(){let{header,player,settings}=this.viewer;if(!header||this.track.hidden)return;this.first!==player&&this.name();
let{first,last,now}=player.range(settings);this.slider.value=String((now-first)/(last-first||1));let text=player.varies?
this.moment(header):`${now.toFixed(1)} s`;this.timeText.textContent!==text&&(this.timeText.textContent=text)}moment(header){
let{player}=this.viewer;return this.date(header)??withUnit(numberText(player.time),header.slices.timeUnit)}date({slices}){
return dateText(slices.dates,slices.times,this.viewer.player.time)}lookOf({show_level,strength,contrast}){return`${show_level}\
 ${strength} ${contrast}`}showLegend(){let{header,settings,parts}=this.viewer;this.legendLook=this.lookOf(settings),this.
colours.update(),header&&this.legend.show(header,settings,parts.get("cmap")?.data)}showKinds(kinds){let{header}=this.viewer,
ground=header?groundKinds(header):[];this.legend.showKinds([...kinds,...ground])}read(point,ground=null){let{header}=this.
viewer;this.readout.replaceChildren(),this.legend.point(null);let position=point?.position??ground;if(!position||!header)
return;let{parts,camera}=this.viewer;if(this.readout.append(dom("span",{},[placeText(position,header,parts,camera)])),!point)
return;point.mark&&this.readout.append(dom("b",{},[point.mark]));let{name,label,unit:unit3}=header.scalars,value=point.values[name??
""];value!==void 0&&(this.readout.append(dom("b",{},[withUnit(`${label} ${numberText(value)}`,unit3)])),this.legend.point(
header,value))}fold(open=!1){this.isOpen=open,this.arrange()}toggle(shown=!this.isShown){if(shown!==this.isShown){this.isShown=
shown;for(let{panel}of this.viewer.together)panel.arrange();this.viewer.options.onControls?.(shown)}}get isFramed(){let{
header,options}=this.viewer;return(options.follows?.panel.isShown??this.isShown)&&!options.bare&&header!==null}chooseAxes(kind){
this.axesKind=kind,this.arrange()}showAxes(){let{header}=this.viewer,usual=header&&hasTicks(header)?"ticks":"none",kind=this.
axesKind??header?.axes??usual,{clientHeight}=this.viewer.root,shown=this.isFramed&&clientHeight>=SMALL_PX?kind:"none";this.
axesMenu.value=kind,this.viewer.root.dataset.axes=shown,this.axes.draw(shown)}arrange(){let{header,options,root}=this.viewer,
isReady=header!==null,follows=!!options.follows,isTiny=root.clientHeight<TINY_PX;this.bar.hidden=isTiny||!(this.isShown||
follows&&this.isFramed)||!isReady,this.bar.style.visibility=follows?"hidden":"",this.handle.hidden=isTiny||this.isShown||
!isReady||follows,this.head.hidden=!(this.isShown||follows)||!isReady,this.controls.element.hidden=!this.isShown||!this.
isOpen||!isReady,root.classList.toggle("flowtex-open",!this.controls.element.hidden),root.classList.toggle("flowtex-fram\
ed",this.isFramed),root.classList.toggle("flowtex-small",root.clientHeight<SMALL_PX),root.classList.toggle("flowtex-tiny",
isTiny),this.showAxes(),this.gear.setAttribute("aria-pressed",String(this.isOpen)),this.keepFocus()}showHelp(shown=this.
help.element.hidden){shown!==!this.help.element.hidden&&(this.help.show(shown),this.keepFocus())}keepFocus(){this.focus.
keep()}afterFocus(lost){let{root}=this.viewer;return this.bar.hidden?this.handle.hidden?root:this.handle:this.controls.element.
contains(lost)?this.gear:root}wait(missing,isMade,isCoarse=!1,isFinding=!1){let{viewer,busy}=this,{pending=0,wanted=0}=viewer.
tiles??{},details=isCoarse?`Fewer details while ${viewer.player.playing?"playing":"moving"}`:"",doing="";missing.length?
doing="Loading data":isMade?pending?doing="Loading tiles":isFinding&&(doing="Finding critical points"):doing="Tracing pa\
ths",this.isFinding=isFinding;let count2=doing==="Loading tiles"?`: ${wanted-pending} of ${wanted}`:doing?" …":details;
this.doing.textContent!==doing&&(this.doing.textContent=doing),this.count.textContent!==count2&&(this.count.textContent=
count2),busy.hidden=!(doing||count2);let{source,isComing}=viewer.options;!missing.length||source?.hasSteps||isComing?.()||
this.lateTimer||(this.lateTimer=viewer.lifetime.later(()=>{this.lateTimer=null;let names=viewer.lacking.join(", ");names&&
this.fail("The scene is not complete.",`Missing: ${names}`)},LATE_MS))}hint(shown){let{lifetime}=this.viewer;lifetime.cancel(
this.hintTimer),this.hintTimer=shown?lifetime.later(()=>this.hint(!1),HINT_MS):null,this.hintBox.hidden=!shown}tell(text){
this.words.has(text)||(this.words.add(text),this.told.textContent=text,this.told.hidden=!1)}clear(){this.wait([],!0,!1,this.
isFinding),this.note.hidden=!0,delete this.viewer.root.dataset.failed}fail(problem,detail){this.note.replaceChildren(dom(
"strong",{},[problem]),dom("pre",{},[detail])),this.note.hidden=!1,this.busy.hidden=!0,this.viewer.root.dataset.failed="\
true",this.viewer.options.onError?.(problem,detail)}fullscreen(){let{root,together}=this.viewer;toggleFullscreen(together.
length>1&&root.parentElement||root)}async save(){let{viewer}=this,href=URL.createObjectURL(await pictureOf(viewer.together)),
name=(viewer.header?.name||"flow").replace(FORBIDDEN," ").trim();dom("a",{href,download:`${name}.png`}).click(),viewer.lifetime.
later(()=>URL.revokeObjectURL(href),SAVED_MS)}};var StreamedPainter=class{view;isPainted=!0;constructor(view){this.view=view}resize(width,height){let{canvas}=this.view,
before=new OffscreenCanvas(Math.max(canvas.width,1),Math.max(canvas.height,1));before.getContext("2d")?.drawImage(canvas,
0,0),[canvas.width,canvas.height]=[width,height],this.pen?.drawImage(before,0,0,width,height)}get pen(){return this.view.
canvas.getContext("2d",{alpha:!1})}frame(now){let{view}=this;view.camera||view.place(),!(!view.player.playing||!this.isPainted)&&
(this.isPainted=!1,view.advance(now))}show(picture,left,width,isSharp){let{view}=this,{canvas,panel}=view;this.pen?.drawImage(
picture,left,0,width,picture.height,0,0,canvas.width,canvas.height),this.isPainted=!0,panel.wait([],!0,!isSharp),view.painted(
isSharp)}};var CLICK_PX=4,CLICK_MS=450,POINTED_MS=1500,HOVER_MS=90,KEY_STEP=.2,NOTCH_SIZES=[100,3,1],PINCH_PX=20,MOST_NOTCHES=4;function placeIn2(element,event){
let box=element.getBoundingClientRect();return{x:2*(event.clientX-box.left)/Math.max(box.width,1)-1,y:1-2*(event.clientY-
box.top)/Math.max(box.height,1)}}var Pointers=class{down=new Map;viewer;isOther=!1;asked=null;press={x:0,y:0,time:0,isDrag:!1};lastLook=0;look=null;pointed=null;lastPointed=-1/0;constructor(viewer){
this.viewer=viewer;let{canvas,root,options,lifetime}=viewer;root.classList.toggle("flowtex-guarded",options.guarded??!1),
options.guarded&&this.guard();let listen=(kind,call)=>lifetime.listen(canvas,kind,call,{passive:!1});listen("pointerdown",
event=>this.onDown(event)),listen("pointermove",event=>this.onMove(event)),listen("pointerup",event=>this.onUp(event)),listen(
"pointercancel",event=>this.onUp(event)),listen("pointerleave",()=>this.leave()),listen("contextmenu",event=>event.preventDefault()),
listen("wheel",event=>this.onWheel(event)),listen("dblclick",event=>{viewer.card.close(),this.zoom(2,event)}),lifetime.listen(
root,"keydown",event=>this.onKey(event))}guard(){let{root,lifetime}=this.viewer,release=event=>{event.composedPath().includes(
root)||this.hold(!1)};lifetime.listen(document,"pointerdown",release,{capture:!0}),lifetime.listen(document,"wheel",release,
{capture:!0,passive:!0}),lifetime.listen(root,"focus",()=>{root.matches(":focus-visible")&&this.hold(!0)})}hold(held){this.
viewer.root.classList.toggle("flowtex-held",held),held&&this.viewer.panel.hint(!1)}get isHeld(){let{root,options}=this.viewer;
return!options.guarded||root.classList.contains("flowtex-held")?!0:document.fullscreenElement?.contains(root)??!1}place(event){
return placeIn2(this.viewer.canvas,event)}onDown(event){if(event.button>2)return;let{root,canvas}=this.viewer;root.focus(
{preventScroll:!0,focusVisible:!1}),event.pointerType!=="touch"&&this.hold(!0),canvas.setPointerCapture(event.pointerId),
this.down.set(event.pointerId,this.place(event)),this.isOther=event.button===2||event.shiftKey;let{clientX:x,clientY:y,timeStamp:time}=event;
this.press={x,y,time,isDrag:this.down.size>1},root.classList.add("flowtex-grabbing")}onMove(event){let{camera}=this.viewer;
if(!camera)return;let place=this.place(event),old=this.down.get(event.pointerId);if((event.movementX||event.movementY)&&
(this.lastPointed=performance.now()),!old)return this.hover(place);if(Math.hypot(event.clientX-this.press.x,event.clientY-
this.press.y)>CLICK_PX&&(this.press.isDrag=!0),!this.press.isDrag)return;let before=this.middle();this.down.set(event.pointerId,
place);let now=this.middle();this.down.size>1?(camera.pan(before.x-now.x,before.y-now.y),before.apart>0&&camera.zoomBy(now.
apart/before.apart,now.x,now.y)):camera.flat===this.isOther?camera.rotate(place.x-old.x,place.y-old.y):camera.pan(old.x-
place.x,old.y-place.y),this.leave(),this.viewer.reportCamera()}leave(){this.pointed=this.asked=null,this.viewer.lifetime.
cancel(this.look),this.viewer.panel.read(null)}outdate(){this.pointed&&(this.asked=null,this.viewer.panel.read(null))}again(){
this.pointed&&!this.down.size&&this.hover(this.pointed)}middle(){let[a,b=a]=[...this.down.values()],aspect=this.viewer.camera?.
aspect??1,apart=Math.hypot((a.x-b.x)*aspect,a.y-b.y);return{x:(a.x+b.x)/2,y:(a.y+b.y)/2,apart}}onUp(event){let place=this.
down.get(event.pointerId);if(this.down.delete(event.pointerId),this.down.size||(this.viewer.root.classList.remove("flowt\
ex-grabbing"),event.type!=="pointerup"))return;this.hold(!0);let isQuick=event.timeStamp-this.press.time<CLICK_MS;!place||
this.press.isDrag||!isQuick||event.button!==0||(this.pointed=place,this.viewer.panel.read(this.viewer.card.choose(place.
x,place.y)))}onWheel(event){if(!this.isHeld&&!event.ctrlKey&&!event.metaKey){performance.now()-this.lastPointed<POINTED_MS&&
this.viewer.panel.hint(!0);return}event.preventDefault();let size=event.ctrlKey&&event.deltaMode===0?PINCH_PX:NOTCH_SIZES[event.
deltaMode],notches=clamp(-event.deltaY/size,-MOST_NOTCHES,MOST_NOTCHES);this.zoom((this.viewer.camera?.limits.wheel_zoom??
1)**notches,event)}zoom(factor,event){let{x,y}=this.place(event);this.viewer.camera?.zoomBy(factor,x,y),this.viewer.reportCamera()}hover(place){
let{viewer}=this;this.pointed=place,viewer.lifetime.cancel(this.look);let rest=HOVER_MS-(performance.now()-this.lastLook),
look=()=>{this.look=null,this.lastLook=performance.now();let{x,y}=place,{streamed,reader}=viewer.options;if(streamed){let asked=this.
asked={},show=point=>{asked===this.asked&&!this.down.size&&viewer.panel.read(point,viewer.ground(x,y))};reader?.({place:[
x,y]},!1).then(found=>show(found?.point??null),()=>null)}else viewer.sharp&&viewer.canPick?viewer.panel.read(viewer.point(
x,y),viewer.ground(x,y)):viewer.player.playing||this.hover(place)};this.look=viewer.lifetime.later(look,Math.max(rest,viewer.
sharp?0:HOVER_MS))}onKey(event){let[target]=event.composedPath();event.defaultPrevented||hasModifier(event)||isOfControl(
target,event.key)||!this.command(event)||(event.preventDefault(),event.stopPropagation())}command({key,shiftKey}){let{viewer}=this,
{camera,panel,options}=viewer;if(!camera)return!1;let command=CAMERA_KEYS[key];if(command in DIRECTIONS){let[x,y]=DIRECTIONS[command].
map(way=>way*KEY_STEP);camera.flat===shiftKey?camera.rotate(-x,-y):camera.pan(x,y),viewer.reportCamera()}else if(command===
"closer"||command==="farther"){let{wheel_zoom:notch}=camera.limits;camera.zoomBy(command==="closer"?notch:1/notch),viewer.
reportCamera()}else if(command==="whole")viewer.reset();else if(command==="next"||command==="previous")viewer.step(command===
"next"?1:-1);else if(command==="detail")viewer.choose("lod",!viewer.settings.lod);else if(key===PLAY_KEY)viewer.togglePlaying();else if(key===
FULLSCREEN_KEY)panel.fullscreen();else if(key==="h")(options.follows?.panel??panel).toggle();else if(key===HELP_KEY)panel.
showHelp();else if(key===CLOSE_KEY)panel.fold(),panel.showHelp(!1),viewer.card.close(),this.hold(!1);else return!1;return!0}};var[STILL_MS,STEADY_MS]=[160,400],isEqual2=(a,b)=>JSON.stringify(a)===JSON.stringify(b),placeOf2=({geometry:{center,extent,
shape:shape2}})=>[center,extent,shape2],Viewer=class extends SceneView{options;requests;player=new Player;stage=document.
createElement("div");card=new PointCard(this);panel;pointers;header=null;settings={};frames=0;together=[this];painter;page;given=null;isOnPage=!1;busyUntil=0;toldMoment="";firstCamera=null;keptCamera=null;constructor(element,options={}){
super(),this.options=options,this.requests=new Requests(options.source??null,this);let{root}=this;root.className="flowte\
x",root.tabIndex=0,Object.assign(root.dataset,{sharp:"false",frames:"0",tiles:"0",lacking:"0"}),root.setAttribute("data-\
lm-suppress-shortcuts","true"),root.setAttribute("role","application"),this.panel=new Panel(this);let make=options.painter??
(view=>new(options.streamed?StreamedPainter:WebGL2Painter)(view));this.painter=make(this),element.append(root),this.page=
new Ground(root,this.lifetime,()=>this.isOnPage&&this.recolour({background:null})),this.pointers=new Pointers(this),this.
graphics.users.add(this),this.observe()}observe(){let{lifetime,root}=this;lifetime.observe(new ResizeObserver(()=>this.panel.
arrange()),root),lifetime.observe(new ResizeObserver(()=>this.resize()),this.stage);let seen=new IntersectionObserver(entries=>{
this.isVisible=entries[entries.length-1].isIntersecting,this.isVisible&&(this.page.look(),this.request())});lifetime.observe(
seen,root),lifetime.listen(document,"visibilitychange",()=>this.request()),lifetime.listen(window,"resize",()=>this.resize())}stats(){
let{objects,users}=this.graphics;return{...this.lifetime.stats(),objects,users:users.size,frames:this.frames}}dispose(){
this.player.playing=!1,super.dispose(),this.canvas.width=this.canvas.height=0,this.root.remove()}setHeader(header,keepsCamera=!1){
if(header.format!==FORMAT){let fault=`The scene has format ${header.format}, and this client reads format ${FORMAT}.`;return this.
panel.fail(fault,"Use the client of the flowtex that made the scene.")}this.requests.stop();let old=this.header;if(old?.
generation!==void 0&&old.generation===header.generation)return this.takeDifferences(old,header);old&&this.holdDraft(STEADY_MS),
this.given=header,header={...header,...this.grounded(header)},this.header=header,this.settings={...header.settings,...header.
own},this.player.setHeader(header),this.requests.setHeader(header),this.painter.open?.(header);let isElsewhere=!old||old.
place!==header.place||!isSamePlace(old.geometry,header.geometry);old&&!isEqual2(placeOf2(old),placeOf2(header))&&(isElsewhere||
!this.options.reader)&&this.card.close(),isElsewhere&&(this.keptCamera=old&&keepsCamera?this.cameraState:null,[this.firstCamera,
this.camera]=[this.keptCamera?null:header.camera,null]),old&&old.generation!==header.generation&&(this.held.clear(name=>isElsewhere&&
!keepsCamera||name.includes("/")),header.surface?.length&&this.keepParts(header.surface)),this.panel.build(),this.resize(),
this.change()}takeDifferences(old,header){let{differs,own,timeShift,name,settings}=header,names=Object.keys({...old.own,
...own});Object.assign(old,{differs,own,timeShift,name}),this.recolour(coloursOf(header)),this.setSettings(Object.fromEntries(
names.map(each=>[each,own?.[each]??settings[each]]))),this.panel.update()}keepParts(names){for(let name of[...this.parts.
keys()])name.includes("/")||names.includes(name)||(this.held.remove(name),this.scene?.forget(name))}recolour(changes){if(!this.
header)return;let colours=this.grounded(changes);Object.assign(this.header,colours),this.fitColours(),Object.assign(this.
given??{},changes),this.scene?.forget("scalars"),this.tiles?.recolour(colours),this.panel.showLegend(),this.change()}fitColours(){
this.header&&this.requests.fit()&&Object.assign(this.header,recoloured(this.header,{},this.parts).colours)}grounded(colours){
return this.page.update(),colours.background===void 0?colours:(this.isOnPage=colours.background===null,{...colours,background:colours.
background??this.page.colour})}chooseColours(choice){if(this.options.onColours)return this.options.onColours(choice);for(let viewer of this.
together){if(!viewer.header)continue;let{colours,part}=recoloured(viewer.header,choice,viewer.parts);part&&viewer.setPart(
part),viewer.recolour(colours)}}setPart(part){let isOther=super.setPart(part);return isOther&&["cmap","maps",...EARTH_LINES].
includes(part.name)&&this.panel.showLegend(),isOther}setSettings(settings){Object.entries(settings).every(([name,value])=>this.
settings[name]===value)||(Object.assign(this.settings,settings),this.requests.follow(this.settings)&&(this.recolour({}),
this.renew(),this.card.update()),this.panel.update(),this.change())}renew(){this.held.clear(name=>/^(flow|scalars|critical|separatrices|nullclines)\//.
test(name)),this.requests.stop(),this.header&&this.painter.open?.(this.header)}followSetting(name,value){name in(this.header?.
own??{})||this.setSettings({[name]:value})}choose(name,value){this.holdDraft(),this.setSettings({[name]:value}),this.options.
onSetting?.(name,value)}get cameraState(){let state=this.camera?.state??this.keptCamera??this.firstCamera;return state?copyOf(
state):null}setCamera(state){if(!state)this.firstCamera=this.keptCamera=null,this.place();else if(!this.camera)[this.firstCamera,
this.keptCamera]=[copyOf(state),null];else{if(isEqual2(this.camera.state,state))return;this.camera.state=copyOf(state)}this.
change(!0)}reportCamera(){this.holdDraft(),this.change(!0),this.camera&&this.options.onCamera?.(copyOf(this.camera.state))}reset(){
this.camera&&(this.place(),this.reportCamera())}place(){let{header,firstCamera:first,keptCamera:kept,aspect}=this,nodes=this.
parts.get("position")?.data;if(!header||!nodes)return;let camera=this.camera=placedCamera(header,first,nodes,aspect);camera.
pick=(x,y)=>this.point(x,y)?.position??this.ground(x,y),camera.state=kept??camera.state,this.keptCamera=null,this.panel.
showAxes(),(!first||!isEqual2(first,camera.start))&&this.options.onCamera?.(copyOf(camera.state))}get aspect(){return Math.
max(this.stage.clientWidth,1)/Math.max(this.stage.clientHeight,1)}get playing(){return this.player.playing}setTime(time){
this.player.seek(time),this.panel.tick(),this.change()}followTime(time){let{timeShift=0}=this.header??{};if(timeShift===
null)return;let[first,last]=this.player.span,own=time+timeShift;this.setTime(first<=own&&own<=last?own:last)}step(count2){
let{player,options}=this;if(options.follows)return options.follows.step(count2);player.varies&&(this.pause(),this.setTime(
player.stepFrom(count2)),options.onTime?.(player.time))}scrub(share){let{player,options}=this,{first,last}=player.range(
this.settings),value=first+share*(last-first);this.holdDraft(),player.varies?(this.setTime(value),options.onTime?.(player.
time)):(this.setClock(value),options.onClock?.(player.clock))}setClock(seconds){this.player.clock=seconds,this.panel.tick(),
this.change()}play(){if(this.options.follows)return this.options.follows.play();this.playing||!this.header||(!this.player.
varies&&this.settings.motion==="off"&&this.choose("motion","speed"),this.player.start(),this.panel.update(),this.request(),
this.options.onPlaying?.(!0))}pause(){if(this.options.follows)return this.options.follows.pause();this.playing&&(this.player.
playing=!1,this.panel.update(),this.change(),this.options.onPlaying?.(!1))}togglePlaying(){let leader=this.options.follows??
this;leader.playing?leader.pause():leader.play()}holdDraft(duration=STILL_MS){this.busyUntil=performance.now()+duration}get isHeld(){
return performance.now()<this.busyUntil}change(cameraOnly=!1){let parts=this.camera&&this.requests.formula?.look(this.camera,
this.parts.keys());for(let part of parts??[])this.setPart(part);this.painter.restart?.(cameraOnly),cameraOnly||this.pointers.
outdate(),this.card.draw(),this.panel.showAxes(),this.setSharp(!1),this.request()}refine(){this.painter.refine?.(),this.
setSharp(!1),this.request()}draw(){this.frame(performance.now(),performance.now()+FRAME_MS)}painted(isComplete){this.root.
dataset.drawn="true",isComplete&&(this.frames+=1,this.root.dataset.frames=String(this.frames),this.panel.clear()),this.followMoment(),
this.setSharp(isComplete&&!this.playing),this.sharp||this.request()}followMoment(){let moment=String(this.shown);moment!==
this.toldMoment&&(this.toldMoment=moment,this.playing&&this.options.reader?this.card.hide():this.card.update())}setSharp(sharp){
sharp!==this.sharp&&(this.sharp=sharp,this.root.dataset.sharp=String(sharp),sharp&&(this.card.update(),this.pointers.again(),
this.options.onFrame?.()))}resize(){let ratio=Math.max(window.devicePixelRatio||1,.1),{clientWidth,clientHeight}=this.stage,
[width,height]=[clientWidth,clientHeight].map(n=>Math.max(Math.round(n*ratio),1));if(width===this.canvas.width&&height===
this.canvas.height)return;let{painter,canvas}=this;painter.resize?painter.resize(width,height):[canvas.width,canvas.height]=
[width,height],this.camera&&(this.camera.aspect=this.aspect,isEqual2(this.camera.state,this.camera.start)&&this.place()),
this.change()}get ratio(){return this.canvas.height/Math.max(this.stage.clientHeight,1)}lost(){super.lost(),this.root.dataset.
sharp="false"}get shown(){return this.painter.shown??null}get lacking(){return this.painter.lacking??[]}tell(reason){this.
panel.tell(reason)}fail(error){this.pause(),this.panel.fail("The picture could not be drawn.",String(error))}advance(now){
let{player,options,painter}=this,isMade=steps=>painter.make?.(steps,now)??!0;!player.playing||!player.advance(now,isMade)||
(player.varies?(options.onTime?.(player.time),this.pointers.outdate()):options.onClock?.(player.clock),this.panel.tick(),
painter.restart?.(!1),this.setSharp(!1))}get rows(){return this.stage.clientHeight}get canPick(){return this.painter.canPick??
!1}point(x,y){return this.find(x,y)?.point??null}ground(x,y){let{header,camera}=this;return header&&camera&&groundAt(header,
camera,x,y)}};var EVENTS={onCamera:"camera",onTime:"time",onClock:"clock",onPlaying:"playing",onSetting:"setting",onPoint:"point",onControls:"\
controls",onAxes:"axes",onFrame:"frame",onError:"error"},FlowtexView=class extends HTMLElement{options={};viewers=[];shown=[];connectedCallback(){
let{style}=this;this.classList.add("flowtex-views"),style.display||="flex",style.gap||="2px",style.width||="100%",style.
height||="100%"}get first(){return this.viewers[0]}get scenes(){return this.shown}set scenes(scenes2){let sources=scenes2.
map(({source})=>source),isSame=this.shown.length===scenes2.length&&this.shown.every(({source},n)=>source===sources[n]);if(this.
shown=scenes2,isSame||this.open(scenes2.length,n=>({source:sources[n]})),scenes2.forEach(({header},n)=>this.viewers[n].setHeader(
header)),scenes2.forEach(({parts},n)=>parts.forEach(part=>this.viewers[n].setPart(part))),!isSame)for(let{requests}of this.
viewers)requests?.open()}open(count2,own=()=>({})){this.dispose();for(let n=0;n<count2;n+=1){let follower=n?{controls:!1,
follows:this.first}:{},viewer=new Viewer(this,{...this.options,...this.reports(n),...own(n),...follower});Object.assign(
viewer.root.style,{flex:"1 1 0",minWidth:"0"}),this.viewers.push(viewer)}for(let viewer of this.viewers)viewer.together=
this.viewers}paint(picture,gap,isSharp){let count2=this.viewers.length,width=(picture.width-(count2-1)*gap)/count2;this.
viewers.forEach((viewer,n)=>viewer.painter.show?.(picture,n*(width+gap),width,isSharp))}dispose(){for(let viewer of this.
viewers)viewer.dispose();this.viewers=[]}reports(n){let tell=(name,...values)=>{this.options[name]?.(...values);let detail=values.
length>1?values:values[0];this.dispatchEvent(new CustomEvent(EVENTS[name],{detail}))},names=Object.keys(EVENTS),told=Object.
fromEntries(names.map(name=>[name,(...values)=>tell(name,...values)])),follow=call=>{for(let[m,other]of this.viewers.entries())
m!==n&&call(other)};return{...told,onCamera:camera=>{follow(other=>other.setCamera(camera)),tell("onCamera",camera)},onTime:time=>{
follow(other=>other.followTime(time)),tell("onTime",time)},onClock:clock=>{follow(other=>other.setClock(clock)),tell("on\
Clock",clock)},onSetting:(name,value)=>{follow(other=>other.followSetting(name,value)),tell("onSetting",name,value)}}}};
function define(){let name="flowtex-view";for(let n=2;customElements.get(name);n+=1)name=`flowtex-view-${n}`;customElements.
define(name,FlowtexView)}define();function mountPage(element,scenes2,options={}){let view=new FlowtexView;return view.options=
options,element.append(view),view.scenes=scenes2,view.first}var FIRST_POINT=[-.4,.5],ZOOM="zoom",SLIDERS=[["samples","Samples, K",1,49,2],["spacing","Spacing, Δt",.1,3,.1],["grain",
"Grain, pixels",2,24,1],["seed","Noise seed",0,20,1],[ZOOM,"Zoom",0,12,.25]],KERNELS={hann:"smooth",box:"even",ramp:"fal\
ling"},ROW2=40;function row(name,count2,marks){let bars=marks.map(({at,y,height,fill,title})=>{let words=shape("title",{},
[document.createTextNode(title)]);return shape("rect",{x:at+.04,y,width:.92,height:Math.max(height,.4),fill},[words])}),
box={viewBox:`0 0 ${count2} ${ROW2}`,preserveAspectRatio:"none","aria-hidden":"true"},svg=shape("svg",box,bars);return dom(
"div",{class:"explained-row"},[dom("span",{},[name]),svg])}var greyText=grey=>`rgb(${Array(3).fill(Math.round(255*grey)).
join()})`,signed=value=>`${value<0?"−":"+"}${Math.abs(value).toFixed(2)}`,Explanation=class{options;controls=dom("div",
{class:"explained-controls"});strip=dom("div",{class:"explained-strip"});words=dom("p",{class:"explained-sum",role:"stat\
us"});chosen=new Map;shows=new Map;viewer=null;sum=null;isBegun=!1;constructor(element){this.options={controls:!1,explainer:{
explain:pixel=>this.tell(pixelSum(pixel)),clear:()=>{this.tell(null)}}};for(let slider of SLIDERS)this.controls.append(this.
slider(slider));this.controls.append(this.menu(),this.box());let panel=dom("div",{class:"explained"},[this.controls,this.
strip,this.words]);element.after(panel),this.tell(null)}attach(view){let viewer=this.viewer=view.first;view.addEventListener(
"frame",()=>this.begin()),view.addEventListener("camera",()=>this.follow()),this.isBegun=!1,viewer.setSettings(Object.fromEntries(
this.chosen));for(let[name,show]of this.shows)name in viewer.settings&&show(viewer.settings[name]);this.shows.get(ZOOM)?.(
0)}begin(){this.isBegun||(this.isBegun=!0,this.viewer?.card.choose(...FIRST_POINT))}follow(){let{viewer}=this;viewer?.camera&&
this.shows.get(ZOOM)?.(Math.log2(viewer.camera.zoom)),viewer?.card.update()}change(name,value){let{viewer,sum}=this;if(name!==
ZOOM&&this.chosen.set(name,value),!!viewer?.camera){if(name===ZOOM){let{camera}=viewer,point=sum?.samples[sum.middle].position,
place=(point&&camera.project(point))??[0,0];camera.zoomBy(2**Number(value)/camera.zoom,...place),viewer.reportCamera()}else
viewer.choose(name,value);viewer.card.update()}}slider([name,label,low,high,step]){let range={min:`${low}`,max:`${high}`,
step:`${step}`},input=dom("input",{type:"range","data-setting":name,...range}),output=dom("output"),write=value=>{output.
textContent=name===ZOOM?`×${numberText(2**value,2)}`:numberText(value,2)};return input.addEventListener("input",()=>{write(
input.valueAsNumber),this.change(name,input.valueAsNumber)}),this.shows.set(name,value=>{input.value=String(value),write(
Number(value))}),dom("label",{},[dom("span",{},[label]),output,input])}menu(){let options=Object.entries(KERNELS).map(([
value,name])=>dom("option",{value},[name])),input=dom("select",{"data-setting":"kernel"},options);return input.addEventListener(
"change",()=>this.change("kernel",input.value)),this.shows.set("kernel",value=>{input.value=String(value)}),dom("label",
{},[dom("span",{},["Kernel"]),input])}box(){let input=dom("input",{type:"checkbox","data-setting":"lod"});return input.addEventListener(
"change",()=>this.change("lod",input.checked)),this.shows.set("lod",value=>{input.checked=!!value}),dom("label",{class:"\
explained-box"},[input,dom("span",{},["Level of detail"])])}tell(sum){if(this.sum=sum,!sum)return this.words.replaceChildren(
"Click a point of the picture."),this.strip.replaceChildren(),[];let{samples,mean,gain,grey,level}=sum,most=Math.max(...samples.
map(({weight})=>weight)),products=samples.map(({weight,noise})=>weight*noise),largest=Math.max(...products.map(Math.abs),
1e-9),marks=mark=>samples.map(({weight,noise},at)=>{let title=`sample ${at-sum.middle}: weight ${weight.toFixed(3)}, noi\
se ${signed(noise)}`;return{at,title,...mark(at)}}),noises=marks(n=>({y:0,height:ROW2,fill:greyText(samples[n].grey)})),
weights2=marks(n=>{let height=samples[n].weight/most*ROW2;return{y:ROW2-height,height,fill:"currentColor"}}),both=marks(
n=>{let height=Math.abs(products[n])/largest*ROW2/2;return{y:products[n]>0?ROW2/2-height:ROW2/2,height,fill:"currentColo\
r"}}),ends2=dom("div",{class:"explained-ends"},[dom("span",{},["← where the particle was"]),dom("span",{},["where it w\
ill be →"])]);this.strip.replaceChildren(row("noise",samples.length,noises),row("weight",samples.length,weights2),row(
"product",samples.length,both),ends2);let swatch=dom("span",{class:"explained-pixel"});return swatch.style.background=greyText(
grey),this.words.replaceChildren(`${samples.length} samples at level ${level.toFixed(1)}. Sum of the products: ${signed(
mean)}; `,`times ${gain.toFixed(2)}, so that the contrast is the same for every K: `,dom("strong",{},[signed(gain*mean)]),
", this grey: ",swatch),samples}};var LOADED_HEIGHTS=.5,KEPT_HEIGHTS=2,EXPLAINED=".flowtex-explained",scenes=new Map,texts=new Map,underway=new Map;function handedOver(address,takers){
let name=address.replace(/^.*\//,"").replace(/\.js$/,""),begun=underway.get(address);if(begun)return begun;let result2=new Promise(
(resolve,reject)=>{let script=document.createElement("script");takers.set(name,resolve),script.src=address,script.onload=
()=>script.remove(),script.onerror=()=>reject(new Error(`${address} cannot be loaded`)),document.head.append(script)}).finally(
()=>underway.delete(address));return underway.set(address,result2),result2}async function fetchScene({dataset:{scene=""}}){
let{headers,parts}=await handedOver(scene,scenes),apart=digest=>handedOver(scene.replace(/[^/]*$/,`${digest}.js`),texts),
known=new Map,result2=headers.map(header=>({header:{...headers[0],...header},parts:[]})),read=async(info,text)=>partOfText(
info,text??await apart(info.digest));return await Promise.all(parts.map(async([view,info,text])=>{let part=known.get(info.
digest)??read(info,text);known.set(info.digest,part),result2[view].parts.push({...await part,name:info.name})})),result2}
var LiveView=class{element;explanation;view=null;isWanted=!1;isLoading=!1;constructor(element){this.element=element,this.
explanation=element.closest(EXPLAINED)&&new Explanation(element);let within=heights=>({rootMargin:`${100*heights}% 0%`}),
observe=(heights,call)=>new IntersectionObserver(([entry])=>call(entry.isIntersecting),within(heights)).observe(element);
observe(LOADED_HEIGHTS,isNear2=>isNear2&&void this.show()),observe(KEPT_HEIGHTS,isNear2=>isNear2||this.leave())}async show(){
if(this.isWanted=!0,this.view||this.isLoading)return;this.isLoading=!0;let{element}=this;try{let data=await fetchScene(element);
if(!this.isWanted)return;for(let{header}of data)header.background=null;let{explanation}=this,view=this.view=new FlowtexView;
view.options={guarded:!0,label:element.dataset.label,...explanation?.options},element.append(view),view.scenes=data,explanation?.
attach(view),this.watch()}catch(error){element.title=`This view is a picture only: ${error instanceof Error?error.message:
error}`}finally{this.isLoading=!1}}watch(){let{element}=this,look=()=>{if(element.querySelector('[data-sharp="false"]'))
return;seen.disconnect(),element.dataset.live="true";let isCalm=matchMedia("(prefers-reduced-motion: reduce)").matches;"\
plays"in element.dataset&&!isCalm&&this.view?.first.play()},seen=new MutationObserver(look);seen.observe(element,{subtree:!0,
attributeFilter:["data-sharp"]})}leave(){this.isWanted=!1,this.view&&(this.view.dispose(),this.view.remove(),this.view=null,
delete this.element.dataset.live)}};function showLiveViews(){let elements=document.querySelectorAll(".flowtex-live");if(elements.
length){window.flowtexScene=(name,scene)=>scenes.get(name)?.(scene),window.flowtexPart=(digest,text)=>texts.get(digest)?.(
text);for(let element of elements)new LiveView(element)}}var Embedded=class{atOnce=1;header;parts=[];tiles=new Map;known;texts;constructor(header,packed,known,texts2){this.header=
header,this.known=known,this.texts=texts2;for(let part of packed){let[{name,digest},text]=part,tile=tilePart(name)?.[0];
tile?this.tiles.set(tile,[...this.tiles.get(tile)??[],part]):this.parts.push(part),tile&&text&&texts2.set(digest,text)}}load=(key,steps)=>{
let needed=((key&&this.tiles.get(nameOf(key)))??[]).filter(([{name}])=>{let part=tilePart(name)?.[1]??"",step=stepOf(part),
isOfAll=part.startsWith("scalars/")&&!isOfStep(part,step,this.header);return Number.isNaN(step)||steps.includes(step)||isOfAll});
return Promise.all(needed.map(packed=>this.unpacked(packed)))};async unpacked([info,text]){let{digest,name}=info,part=this.
known.get(digest);return part?{...part,name}:partOfText(info,text||(this.texts.get(digest)??""))}async kept(packed){let part=await this.
unpacked(packed);return this.known.set(part.digest,part),part}};var HEIGHT_PX=480;function showPacked(element,{headers,parts},openStore,report){let known=new Map,texts2=new Map,embedded=headers.
map((header,n)=>{let own=parts.flatMap(([view2,info,text])=>view2===n?[[info,text]]:[]);return new Embedded({...headers[0],
...header},own,known,texts2)}),isComing=!0,view=new FlowtexView;return view.options={isComing:()=>isComing},element.append(
view),view.scenes=embedded.map(source=>{let{header}=source;return{header,parts:[],source:openStore?openStore(header):source}}),
{view,filled:(async()=>{let{viewers}=view;for(let[n,source]of embedded.entries())for(let[m,part]of source.parts.entries()){
report?.(n,m,source.parts.length);let unpacked=await source.kept(part);if(view.viewers!==viewers)return;viewers[n].setPart(
unpacked)}isComing=!1;for(let viewer of viewers)viewer.change()})()}}function packedModule(scene,openStore){let mount=(element,settings={},height=HEIGHT_PX)=>{
let{view,filled:filled2}=showPacked(element,scene,openStore);view.style.height=`${height}px`;for(let[name,value]of Object.
entries(settings))for(let viewer of view.viewers)viewer.followSetting(name,value);return filled2.catch(error=>view.first?.
panel.fail("The flow cannot be drawn.",error.message)),view};return{mount,render:({model,el})=>{let named=scene.headers[0].
table.map(({name})=>[name,model.get(name)]),settings=Object.fromEntries(named.filter(([,value])=>value!=null)),view=mount(
el,settings,Number(model.get("height"))||HEIGHT_PX);return()=>{view.dispose(),view.remove()}}}}function partsOfPage(){return Array.
from(document.querySelectorAll("script[data-part]"),element=>{element.remove();let{view,part=""}=element.dataset;return[
Number(view),JSON.parse(part),element.textContent??""]})}async function openPage(openStore){let place=document.getElementById(
"flowtex"),status=document.getElementById("status"),loading=document.getElementById("loading");try{let headers=await unzipped(
document.getElementById("headers")?.textContent??"").json(),look=()=>{status.hidden=!place.querySelector('[data-failed="\
true"]'),loading.hidden=!status.hidden,status.textContent="This browser cannot draw the flow because it has no WebGL2; t\
his is a still picture.",!place.querySelector('.flowtex:not([data-drawn="true"])')&&(watch.disconnect(),document.getElementById(
"preview")?.remove(),loading.remove())},watch=new MutationObserver(look),attributeFilter=["data-drawn","data-failed"];watch.
observe(place,{subtree:!0,childList:!0,attributeFilter});let scene={headers,parts:partsOfPage()},{view,filled:filled2}=showPacked(
place,scene,openStore,(n,part,parts)=>{let which=headers.length>1?` of view ${n+1}`:"";loading.lastElementChild.textContent=
`${which}, ${part} of ${parts} parts`}),{root}=view.first;document.addEventListener("keydown",event=>forwardKeys(root,event)),
await filled2,loading.textContent="Drawing the first picture"}catch(error){loading.remove(),status.hidden=!1;let reason=error instanceof
Error?error.message:String(error);throw status.textContent=`The flow cannot be drawn here: ${reason}`,error}}var CAMERA_MS=100,TIME_MS=250,STILL_MS2=1500,STILL_FORMAT={type:"image/jpeg",quality:.9},HEADERS=["_header","_header_bes\
ide"],ROOM=".flowtex-room { width: 100%; min-width: 160px; flex: 0 9999 auto }",HEIGHT_PX2=480;function opened(message,buffers){
let graphics=sharedGraphics(),{view=0,generation=0,parts:infos=[]}=message,delivery={view,generation,parts:[]};return infos.
forEach((info,n)=>{let part=graphics.hold(graphics.stock.get(info.digest)?.part??decoded(info,buffers[n]));delivery.parts.
push({...part,name:info.name})}),delivery}function discard(deliveries){for(let{parts}of deliveries)for(let part of parts)
sharedGraphics().release(part)}var mailbox=new Map;function initialize({model}){let key=model.get("_key");mailbox.set(key,
[]);let receive=(message,buffers)=>{message?.kind==="parts"&&mailbox.get(key)?.push(opened(message,buffers))};return model.
on("msg:custom",receive),()=>{model.off("msg:custom",receive),discard(mailbox.get(key)??[]),mailbox.delete(key)}}function render({
model,el}){let view=new WidgetView(model,el);return()=>view.dispose()}function cameraOf(state){let camera=state;return camera&&
Array.isArray(camera.position)?camera:null}var WidgetView=class{model;view=new FlowtexView;viewers;first;sent=new Map;handlers=[];early;sources=HEADERS.
map((_,view)=>new Messages(content=>this.model.send({...content,view})));frameTimer=null;hasSentFrame=!1;sheet=new CSSStyleSheet;constructor(model,element){
this.model=model;let beside=model.get("_header_beside");element.append(this.view),this.viewers=this.makeViewers(beside?.
format?2:1),[this.first]=this.viewers;let key=model.get("_key");this.early=mailbox.get(key)??[],mailbox.delete(key),this.
sheet.replaceSync(ROOM),document.adoptedStyleSheets.push(this.sheet),this.connect(),this.resize(),this.viewers.forEach((_,n)=>this.
takeHeader(n)),model.get("playing")&&this.first.play(),this.viewers.every(({scene,lacking})=>scene&&!lacking.length)||model.
send({kind:"ready"})}makeViewers(count2){let{model,view}=this;view.options={rebuild:!0,guarded:!0,controls:model.get("ba\
r")??!0,onColours:changes=>model.send({kind:"appearance",changes})},view.open(count2,n=>({source:this.sources[n]}));let hear=(name,take)=>view.
addEventListener(name,event=>take(event.detail)),slowly=(name,wait)=>{hear(name,throttled((call,delay)=>view.first.lifetime.
later(call,delay),wait,value=>this.send(name,value)))};return slowly("camera",CAMERA_MS),slowly("time",TIME_MS),slowly("\
clock",TIME_MS),hear("playing",playing=>this.send("playing",playing)),hear("point",point=>this.send("point",point)),hear(
"setting",([name,value])=>this.send(name,value)),hear("controls",shown=>this.send("bar",shown)),hear("axes",kind=>this.send(
"axes",kind)),hear("frame",()=>this.planFrame()),view.viewers}send(name,value){this.sent.set(name,JSON.stringify(value)),
this.model.set(name,value),this.model.save_changes()}planFrame(){let{lifetime}=this.first;lifetime.cancel(this.frameTimer);
let wait=this.hasSentFrame?STILL_MS2:0;this.frameTimer=lifetime.later(()=>{this.sendFrame()},wait)}async sendFrame(){let{
first,viewers}=this;if(!viewers.every(({sharp})=>sharp))return;let{dataset}=first.root,{frames}=dataset;this.hasSentFrame=
!0;let data=await(await pictureOf(viewers,1/first.ratio,STILL_FORMAT)).arrayBuffer();if(first.lifetime.isOver)return;let size=[
this.view.clientWidth,this.view.clientHeight];this.model.send({kind:"frame",size,ground:first.header?.background},void 0,
[data]),dataset.still=frames}becomeLive(){let{root}=this.first;if(root.dataset.live||root.dataset.failed)return;root.dataset.
live="true";let still=`[data-flowtex~="${String(this.model.get("_key"))}"]`;this.sheet.insertRule(`${still}, :is(.jp-Out\
putArea-child, .output_area):has(> * > ${still}) { display: none !important }`)}listen(event,call){this.handlers.some(([
other])=>other===event)||(this.handlers.push([event,call]),this.model.on(event,call))}follow(name,take){this.listen(`cha\
nge:${name}`,()=>{let value=this.model.get(name);this.sent.get(name)!==JSON.stringify(value)&&take(value),this.sent.delete(
name)})}connect(){let{viewers,first}=this;this.listen("msg:custom",(message,buffers)=>{message?.kind==="parts"&&this.take(
opened(message,buffers)),message?.kind==="loaded"&&this.sources[message.view??0]?.end(message),message?.kind==="error"&&
first.panel.fail("The kernel could not continue.",message.text??"")}),viewers.forEach((_,n)=>this.listen(`change:${HEADERS[n]}`,
()=>this.takeHeader(n))),this.listen("change:size",()=>this.resize()),this.follow("camera",value=>{let camera=cameraOf(value);
camera&&viewers.forEach(viewer=>viewer.setCamera(camera))}),this.follow("time",time=>viewers.forEach(viewer=>viewer.setTime(
Number(time)))),this.follow("clock",clock=>viewers.forEach(viewer=>viewer.setClock(Number(clock)))),this.follow("playing",
playing=>playing?first.play():first.pause()),this.follow("bar",shown=>first.panel.toggle(!!shown)),this.follow("axes",kind=>viewers.
forEach(({panel})=>panel.chooseAxes(kind)))}resize(){let[width,height]=this.model.get("size")??[0,0],{style,parentElement}=this.
view;style.width=width?`${width}px`:"100%",style.height=`${height||HEIGHT_PX2}px`,parentElement?.classList.toggle("flowt\
ex-room",!width)}takeHeader(n){let{model}=this,header=model.get(HEADERS[n]);if(!header?.format)return;let rows=header.table??
[],values=rows.map(row2=>[row2.name,model.get(row2.name)??row2.default]),now={shaders:model.get("_shaders")[n],settings:Object.
fromEntries(values),camera:cameraOf(model.get("camera")),time:model.get("time")??0,clock:model.get("clock")??0,axes:model.
get("axes")??null};this.viewers[n].setHeader({...header,...now},!0);for(let delivery of this.early.splice(0))this.take(delivery);
for(let{name}of rows)this.follow(name,value=>{for(let viewer of this.viewers)viewer.followSetting(name,value)})}take(delivery){
let viewer=this.viewers[delivery.view];if(!viewer)return;let generation=viewer.header?viewer.header.generation??0:-1;if(delivery.
generation>generation)return void this.early.push(delivery);let isOld=name=>delivery.generation!==generation&&name.includes(
"/");for(let part of delivery.parts)isOld(part.name)||viewer.setPart(part);discard([delivery]),this.becomeLive()}dispose(){
for(let[event,call]of this.handlers)this.model.off(event,call);discard(this.early),document.adoptedStyleSheets=document.
adoptedStyleSheets.filter(s=>s!==this.sheet),this.view.dispose(),this.view.remove()}};document.readyState==="loading"?document.addEventListener("DOMContentLoaded",showLiveViews):showLiveViews();return __toCommonJS(core_exports);})();
